//! PNG and JPEG files as rows of raw pixels, decoded within limits.

use std::io::Cursor;

use image::{ImageFormat, ImageReader};
use png::{ColorType, Decoder, DecodingError, Limits, Transformations};

use super::label_map::Key;

/// Most pixels that an image may have: 8192 x 8192.
pub const MAX_PIXELS: u64 = 1 << 26;

/// A deflate stream cannot expand more than this: a header that claims more is not honest.
const MAX_EXPANSION: u64 = 1032;

/// A JPEG spends at least one bit on the mean of each 8 x 8 block of pixels.
const MAX_JPEG_EXPANSION: u64 = 8 * 64;

/// First bytes of a JPEG file.
pub(super) const JPEG_MAGIC: &[u8] = b"\xff\xd8\xff";

/// Why a file is not a readable image.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PixelError {
    /// More pixels than are read; nothing was allocated for them.
    #[error("the image claims {width} x {height} pixels, at most {MAX_PIXELS} are read")]
    TooLarge {
        /// Claimed columns.
        width: u32,
        /// Claimed rows.
        height: u32,
    },
    /// The file is too short for the size in its header.
    #[error("truncated: {bytes} bytes cannot hold {width} x {height} pixels")]
    TooShort {
        /// Claimed columns.
        width: u32,
        /// Claimed rows.
        height: u32,
        /// Bytes of the file.
        bytes: usize,
    },
    /// Not a PNG, or a damaged or truncated one.
    #[error("not a readable PNG: {0}")]
    Png(#[from] DecodingError),
    /// Not a JPEG, or a damaged or truncated one.
    #[error("not a readable JPEG: {0}")]
    Jpeg(#[from] image::ImageError),
    /// Not a PNG, JPEG or WebP, or a damaged or truncated one.
    #[error("not a readable picture: {0}")]
    Picture(image::ImageError),
}

/// A decoded image: rows from the top, `stride` bytes a pixel.
pub struct Pixels {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Bytes a pixel; the first is a number when there are fewer than three.
    pub stride: usize,
    bytes: Vec<u8>,
    palette: Option<Vec<u8>>,
}

/// The columns and colours of a PNG, JPEG or WebP, row after row from the top.
///
/// # Errors
/// [`PixelError`]; an image above [`MAX_PIXELS`] is refused from its header.
pub fn colours(bytes: &[u8]) -> Result<(usize, Vec<[u8; 3]>), PixelError> {
    let reader = || {
        let guessed = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
        guessed.map_err(|e| PixelError::Picture(e.into()))
    };
    let (width, height) = reader()?.into_dimensions().map_err(PixelError::Picture)?;
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(PixelError::TooLarge { width, height });
    }
    let picture = reader()?.decode().map_err(PixelError::Picture)?;
    let rgb = picture.into_rgb8().into_raw();
    Ok((width as usize, rgb.as_chunks().0.to_vec()))
}

/// Width and height of a PNG, from its header.
///
/// # Errors
/// [`PixelError::Png`] when it is none.
pub fn size(bytes: &[u8]) -> Result<(f64, f64), PixelError> {
    let mut decoder = Decoder::new(Cursor::new(bytes));
    let header = decoder.read_header_info()?;
    Ok((header.width.into(), header.height.into()))
}

impl Pixels {
    /// Decodes a PNG; 16-bit samples keep their upper half.
    ///
    /// # Errors
    /// [`PixelError`]; an image above [`MAX_PIXELS`] is refused from its header.
    pub fn decode(bytes: &[u8]) -> Result<Self, PixelError> {
        let limits = Limits {
            bytes: 8 * MAX_PIXELS as usize,
        };
        let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), limits);
        decoder.set_transformations(Transformations::STRIP_16);
        // Compressed texts and profiles could unpack to the limit, and say nothing about labels.
        decoder.set_ignore_text_chunk(true);
        decoder.set_ignore_iccp_chunk(true);
        let header = decoder.read_header_info()?;
        let (width, height) = (header.width, header.height);
        let pixels = u64::from(width) * u64::from(height);
        if pixels > MAX_PIXELS {
            return Err(PixelError::TooLarge { width, height });
        }
        let claimed = header.raw_row_length() as u64 * u64::from(height);
        if claimed / MAX_EXPANSION > bytes.len() as u64 {
            let bytes = bytes.len();
            return Err(PixelError::TooShort {
                width,
                height,
                bytes,
            });
        }
        let mut reader = decoder.read_info()?;
        let (color, depth) = reader.output_color_type();
        let size = reader
            .output_buffer_size()
            .ok_or(DecodingError::LimitsExceeded)?;
        let mut packed = vec![0; size];
        let frame = reader.next_frame(&mut packed)?;
        reader.finish()?;
        let (width, height) = (width as usize, height as usize);
        let bits = depth as usize;
        let bytes = if bits < 8 {
            let rows = packed.chunks_exact(frame.line_size.max(1)).take(height);
            rows.flat_map(|row| unpack(row, bits, width)).collect()
        } else {
            packed
        };
        let palette = reader.info().palette.as_ref().map(|p| p.to_vec());
        Ok(Self {
            width,
            height,
            stride: color.samples(),
            bytes,
            palette: palette.filter(|_| color == ColorType::Indexed),
        })
    }

    /// Decodes a JPEG, whose pixels are always colours.
    ///
    /// # Errors
    /// As [`Pixels::decode`].
    pub fn decode_jpeg(bytes: &[u8]) -> Result<Self, PixelError> {
        let reader = || ImageReader::with_format(Cursor::new(bytes), ImageFormat::Jpeg);
        let (width, height) = reader().into_dimensions()?;
        let pixels = u64::from(width) * u64::from(height);
        if pixels > MAX_PIXELS {
            return Err(PixelError::TooLarge { width, height });
        }
        if pixels / MAX_JPEG_EXPANSION > bytes.len() as u64 {
            let bytes = bytes.len();
            return Err(PixelError::TooShort {
                width,
                height,
                bytes,
            });
        }
        Ok(Self {
            width: width as usize,
            height: height as usize,
            stride: 3,
            bytes: reader().decode()?.into_rgb8().into_raw(),
            palette: None,
        })
    }

    /// The bytes of one row, counted from the top.
    pub fn row(&self, row: usize) -> &[u8] {
        let length = self.width * self.stride;
        &self.bytes[row * length..(row + 1) * length]
    }

    /// True if a pixel is a number (palette index or grey value) rather than a colour.
    pub fn is_numbered(&self) -> bool {
        self.stride < 3
    }

    /// The number of a pixel; `None` in a colour image.
    pub fn number(&self, pixel: &[u8]) -> Option<Key> {
        match pixel {
            &[number] | &[number, _] => Some(Key::Id(number.into())),
            _ => None,
        }
    }

    /// The colour of a pixel; `None` for an index beyond the palette.
    pub fn color(&self, pixel: &[u8]) -> Option<Key> {
        match (pixel, &self.palette) {
            (&[r, g, b, ..], _) => Some(Key::Color([r, g, b])),
            (&[index, ..], Some(palette)) => match palette.chunks_exact(3).nth(index.into()) {
                Some(&[r, g, b]) => Some(Key::Color([r, g, b])),
                _ => None,
            },
            (&[grey, ..], None) => Some(Key::Color([grey; 3])),
            (&[], _) => None,
        }
    }
}

/// One byte a sample from a row of samples of 1, 2 or 4 bits, the leftmost in the highest bits.
fn unpack(row: &[u8], bits: usize, width: usize) -> impl Iterator<Item = u8> {
    let per_byte = 8 / bits;
    (0..width).map(move |x| {
        let shift = 8 - bits * (x % per_byte + 1);
        (row[x / per_byte] >> shift) & ((1 << bits) - 1)
    })
}
