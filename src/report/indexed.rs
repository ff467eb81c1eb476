//! PNG files of at most 256 colours: half as large as others, and figures and pictures look the same.

use std::collections::{HashMap, HashSet};

use color_quant::NeuQuant;

/// Colours of a palette.
const COLOURS: usize = 256;

/// Encodes RGB pixels, row by row from the top. The colours that occur most are kept exactly, of the others (the edges of letters and
/// lines) each becomes the nearest of them.
///
/// # Errors
/// Those of the PNG encoder, which writes to memory.
pub(super) fn png(width: u32, height: u32, rgb: &[u8]) -> Result<Vec<u8>, png::EncodingError> {
    let (pixels, _) = rgb.as_chunks::<3>();
    let mut counts: HashMap<[u8; 3], usize> = HashMap::new();
    for pixel in pixels {
        *counts.entry(*pixel).or_insert(0) += 1;
    }
    let mut by_count: Vec<([u8; 3], usize)> = counts.into_iter().collect();
    by_count.sort_unstable_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    let colours: Vec<[u8; 3]> = by_count.into_iter().map(|(colour, _)| colour).collect();
    let palette = &colours[..colours.len().min(COLOURS)];
    let nearest = |colour: &[u8; 3]| {
        let distance = |other: &[u8; 3]| -> i32 {
            let part = |i: usize| (i32::from(colour[i]) - i32::from(other[i])).pow(2);
            part(0) + part(1) + part(2)
        };
        let places = 0..palette.len();
        places.min_by_key(|&i| distance(&palette[i])).unwrap_or(0) as u8
    };
    let places: HashMap<[u8; 3], u8> = colours.iter().map(|c| (*c, nearest(c))).collect();
    let indices: Vec<u8> = pixels.iter().map(|pixel| places[pixel]).collect();

    encoded(width, height, palette.concat(), &indices)
}

/// Brings a PNG of RGB pixels (a rendered picture, say, of many shades) to at most 256 colours: its own, or those that NeuQuant
/// (Dekker 1994) chooses where it has more; other PNG files stay as they are.
///
/// # Errors
/// Those of the PNG decoder, for bytes that are no PNG, and of the encoder.
pub fn few_colours(bytes: &[u8]) -> Result<Vec<u8>, Box<dyn std::error::Error + Send + Sync>> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info()?;
    let info = reader.info();
    let plain = (info.color_type, info.bit_depth) == (png::ColorType::Rgb, png::BitDepth::Eight);
    let Some(size) = reader.output_buffer_size().filter(|_| plain) else {
        return Ok(bytes.to_vec());
    };
    let mut rgb = vec![0; size];
    let frame = reader.next_frame(&mut rgb)?;
    let (pixels, _) = rgb.as_chunks::<3>();
    let mut colours: HashSet<[u8; 3]> = HashSet::new();
    let is_few = pixels.iter().all(|p| {
        colours.insert(*p);
        colours.len() <= COLOURS
    });
    if is_few {
        return Ok(png(frame.width, frame.height, &rgb)?);
    }
    let rgba: Vec<u8> = pixels
        .iter()
        .flat_map(|&[r, g, b]| [r, g, b, 255])
        .collect();
    let chosen = NeuQuant::new(SAMPLE, COLOURS, &rgba);
    let mut known: HashMap<[u8; 3], u8> = HashMap::new();
    let mut index = |&[r, g, b]: &[u8; 3]| {
        let found = known.entry([r, g, b]);
        *found.or_insert_with(|| chosen.index_of(&[r, g, b, 255]) as u8)
    };
    let indices: Vec<u8> = pixels.iter().map(&mut index).collect();
    Ok(encoded(
        frame.width,
        frame.height,
        chosen.color_map_rgb(),
        &indices,
    )?)
}

/// Number of pixels of which NeuQuant learns from one.
const SAMPLE: i32 = 3;

fn encoded(
    width: u32,
    height: u32,
    palette: Vec<u8>,
    indices: &[u8],
) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Indexed);
    let bits = match palette.len() / 3 {
        0..=2 => 1,
        3..=4 => 2,
        5..=16 => 4,
        _ => 8,
    };
    encoder.set_depth(match bits {
        1 => png::BitDepth::One,
        2 => png::BitDepth::Two,
        4 => png::BitDepth::Four,
        _ => png::BitDepth::Eight,
    });
    encoder.set_palette(palette);
    encoder.set_filter(png::Filter::NoFilter);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&packed(indices, width as usize, bits))?;
    writer.finish()?;
    Ok(bytes)
}

/// Indices of so many bits each, the first in the highest; every row begins with a new byte.
fn packed(indices: &[u8], width: usize, bits: usize) -> Vec<u8> {
    let byte = |own: &[u8]| {
        let places = own.iter().enumerate();
        places.fold(0, |byte, (i, v)| byte | v << (8 - bits * (i + 1)))
    };
    let rows = indices.chunks(width.max(1));
    rows.flat_map(|row| row.chunks(8 / bits).map(byte))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(bytes: &[u8]) -> Vec<u8> {
        let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        pixels.truncate(info.buffer_size());
        pixels
    }

    /// A PNG of RGB pixels without a palette.
    fn plain(width: u32, height: u32, rgb: &[u8]) -> Vec<u8> {
        let mut whole = Vec::new();
        let mut encoder = png::Encoder::new(&mut whole, width, height);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(rgb).unwrap();
        writer.finish().unwrap();
        whole
    }

    #[test]
    fn few_colours_stay_and_many_become_their_nearest() {
        let few: Vec<u8> = (0..200u8).flat_map(|i| [i, 7, 255 - i]).collect();
        assert_eq!(decoded(&png(20, 10, &few).unwrap()), few);
        // 256 grey levels often, others next to them once.
        let mut many: Vec<u8> = (0..=255u8).flat_map(|i| [[i; 3]; 2]).flatten().collect();
        many.extend([10, 11, 10, 200, 200, 202]);
        let found = decoded(&png(514, 1, &many).unwrap());
        assert_eq!(found[..1536], many[..1536]);
        assert_eq!(found[1536..], [10, 10, 10, 201, 201, 201]);
    }

    #[test]
    fn pictures_of_few_colours_stay_as_they_are() {
        for colours in [1, 2, 3, 4, 5, 16, 17, 256] {
            let (width, height) = (37, 11);
            let shade = |i: usize| [(i * i % colours) as u8, 9, 255 - (i % colours) as u8];
            let rgb: Vec<u8> = (0..width * height).flat_map(shade).collect();
            let whole = plain(width as u32, height as u32, &rgb);
            assert_eq!(decoded(&few_colours(&whole).unwrap()), rgb, "{colours}");
        }
    }

    #[test]
    fn pictures_keep_their_look_in_few_colours() {
        let (width, height) = (64, 64);
        let shade = |i: usize| [(i % 64 * 4) as u8, (i / 64 * 4) as u8, 128];
        let rgb: Vec<u8> = (0..width * height).flat_map(shade).collect();
        let whole = plain(width as u32, height as u32, &rgb);
        let few = few_colours(&whole).unwrap();
        let again = decoded(&few);
        let far = rgb.iter().zip(&again).map(|(a, b)| a.abs_diff(*b));
        assert!(far.map(f64::from).sum::<f64>() / (rgb.len() as f64) < 6.0);
        let colours: std::collections::HashSet<&[u8]> = again.chunks(3).collect();
        assert!(colours.len() <= 256);
        // What has a palette stays; what is no PNG is an error.
        assert_eq!(few_colours(&few).unwrap(), few);
        assert!(few_colours(b"no picture").is_err());
    }
}
