//! Buffer views that `EXT_meshopt_compression` compresses, as they are read.

use meshopt::{
    decode_filter_exp, decode_filter_oct, decode_filter_quat, decode_index_buffer,
    decode_index_sequence, decode_vertex_buffer,
};
use serde::Deserialize;

/// The name of the extension.
pub(super) const EXTENSION: &str = "EXT_meshopt_compression";
/// Bytes that a compressed byte may stand for: two bits for sixteen bytes at best.
const MOST_FOR_ONE: usize = 64;

/// A compressed view.
#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Compressed {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: usize,
    pub byte_length: usize,
    byte_stride: usize,
    count: usize,
    mode: Mode,
    #[serde(default)]
    filter: Filter,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Filter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
}

impl Compressed {
    /// The bytes of the view.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub(super) fn decoded(&self, bytes: &[u8]) -> Result<Vec<u8>, String> {
        let Self {
            byte_stride: stride,
            count,
            ..
        } = *self;
        let whole = count.checked_mul(stride);
        let most = bytes.len().saturating_mul(MOST_FOR_ONE);
        if whole.is_none_or(|n| n > most) {
            return Err(format!(
                "{count} elements of {stride} bytes in {} bytes",
                bytes.len()
            ));
        }
        let failed = |e: meshopt::Error| e.to_string();
        match (self.mode, stride) {
            (Mode::Attributes, _) => self.attributes(bytes),
            (_, 2 | 4) if self.filter != Filter::None => Err("indices with a filter".into()),
            (Mode::Triangles, 2) if count.is_multiple_of(3) => {
                Ok(decode_index_buffer::<u16>(bytes, count)
                    .map_err(failed)?
                    .into_iter()
                    .flat_map(u16::to_le_bytes)
                    .collect())
            }
            (Mode::Triangles, 4) if count.is_multiple_of(3) => {
                Ok(decode_index_buffer::<u32>(bytes, count)
                    .map_err(failed)?
                    .into_iter()
                    .flat_map(u32::to_le_bytes)
                    .collect())
            }
            (Mode::Indices, 2) => Ok(decode_index_sequence::<u16>(bytes, count)
                .map_err(failed)?
                .into_iter()
                .flat_map(u16::to_le_bytes)
                .collect()),
            (Mode::Indices, 4) => Ok(decode_index_sequence::<u32>(bytes, count)
                .map_err(failed)?
                .into_iter()
                .flat_map(u32::to_le_bytes)
                .collect()),
            _ => Err(format!("{count} indices of {stride} bytes")),
        }
    }

    fn attributes(&self, bytes: &[u8]) -> Result<Vec<u8>, String> {
        match self.byte_stride / 4 {
            _ if !self.byte_stride.is_multiple_of(4) => {
                Err("a stride that is no multiple of four".into())
            }
            1 => self.words::<1>(bytes),
            2 => self.words::<2>(bytes),
            3 => self.words::<3>(bytes),
            4 => self.words::<4>(bytes),
            5 => self.words::<5>(bytes),
            6 => self.words::<6>(bytes),
            7 => self.words::<7>(bytes),
            8 => self.words::<8>(bytes),
            9 => self.words::<9>(bytes),
            10 => self.words::<10>(bytes),
            11 => self.words::<11>(bytes),
            12 => self.words::<12>(bytes),
            13 => self.words::<13>(bytes),
            14 => self.words::<14>(bytes),
            15 => self.words::<15>(bytes),
            16 => self.words::<16>(bytes),
            _ => Err(format!(
                "a stride of {} bytes, which is not read",
                self.byte_stride
            )),
        }
    }

    /// Elements of `N` words of four bytes.
    fn words<const N: usize>(&self, bytes: &[u8]) -> Result<Vec<u8>, String>
    where
        [u32; N]: Default,
    {
        let mut words: Vec<[u32; N]> =
            decode_vertex_buffer(bytes, self.count).map_err(|e| e.to_string())?;
        let little = |words: Vec<[u32; N]>| -> Vec<u8> {
            words
                .into_iter()
                .flatten()
                .flat_map(u32::to_le_bytes)
                .collect()
        };
        match (self.filter, N) {
            (Filter::None, _) => Ok(little(words)),
            (Filter::Exponential, _) => {
                decode_filter_exp(&mut words);
                Ok(little(words))
            }
            (Filter::Quaternion, 2) => {
                let mut shorts = shorts(&little(words));
                decode_filter_quat(&mut shorts);
                Ok(shorts
                    .into_iter()
                    .flatten()
                    .flat_map(i16::to_le_bytes)
                    .collect())
            }
            (Filter::Octahedral, 2) => {
                let mut shorts = shorts(&little(words));
                decode_filter_oct(&mut shorts);
                Ok(shorts
                    .into_iter()
                    .flatten()
                    .flat_map(i16::to_le_bytes)
                    .collect())
            }
            (Filter::Octahedral, 1) => {
                let mut bytes: Vec<[i8; 4]> = words
                    .iter()
                    .map(|w| w[0].to_le_bytes().map(|b| b as i8))
                    .collect();
                decode_filter_oct(&mut bytes);
                Ok(bytes.into_iter().flatten().map(|b| b as u8).collect())
            }
            _ => Err(format!(
                "{:?} with a stride of {} bytes",
                self.filter, self.byte_stride
            )),
        }
    }
}

fn shorts(bytes: &[u8]) -> Vec<[i16; 4]> {
    let short = |b: &[u8], k: usize| i16::from_le_bytes([b[2 * k], b[2 * k + 1]]);
    let eights = bytes.chunks_exact(8);
    eights
        .map(|b| std::array::from_fn(|k| short(b, k)))
        .collect()
}
