//! Photographs as `data:` addresses: text that holds the picture itself, and leads nowhere.

mod straightened;

use std::io::{BufRead, Cursor, Seek};
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{ImageFormat, ImageReader};

use super::read_bytes;
use edifice_base::{Error, Result};
use edifice_shape::{Photograph, PhotographError, PhotographFormat};

pub use straightened::{Picture, StraightenError};

/// Why a text or a file is no photograph.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadPhotographError {
    /// The text is no address of a picture that it holds.
    #[error(
        "expected a picture as text, data:image/jpeg;base64,... or data:image/png;base64,..., found {0:?}"
    )]
    Address(String),
    /// The text after the comma is not base64.
    #[error("the picture is not base64: {0}")]
    Base64(#[from] base64::DecodeError),
    /// The bytes are of no picture, or of another format than the address says.
    #[error("neither a JPEG nor a PNG picture, or another one than its address says")]
    Format,
    /// Its header cannot be read.
    #[error("the picture cannot be read: {0}")]
    Picture(#[from] image::ImageError),
    /// The picture is too large.
    #[error(transparent)]
    Large(#[from] PhotographError),
}

/// Reads a picture, `.jpg` or `.png`, or a text file that holds its address.
///
/// # Errors
/// Names the file and what is wrong with it.
pub fn read(path: &Path) -> Result<Photograph> {
    let bytes = read_bytes(path)?;
    let read = match std::str::from_utf8(&bytes) {
        Ok(text) if text.starts_with("data:") => of_address(text.trim_end()),
        _ => of_bytes(bytes),
    };
    read.map_err(|e| Error::content(path, e.to_string()))
}

/// The picture of a file's bytes.
///
/// # Errors
/// [`ReadPhotographError`].
pub fn of_bytes(bytes: Vec<u8>) -> Result<Photograph, ReadPhotographError> {
    let reader = ImageReader::new(Cursor::new(&bytes)).with_guessed_format();
    let reader = reader.map_err(image::ImageError::IoError)?;
    let format = format(&reader).ok_or(ReadPhotographError::Format)?;
    let (width, height) = reader.into_dimensions()?;
    Ok(Photograph::new(format, [width, height], bytes)?)
}

/// The format of a picture, if it is one of photographs.
fn format<R: BufRead + Seek>(reader: &ImageReader<R>) -> Option<PhotographFormat> {
    match reader.format()? {
        ImageFormat::Jpeg => Some(PhotographFormat::Jpeg),
        ImageFormat::Png => Some(PhotographFormat::Png),
        _ => None,
    }
}

/// The bytes of a picture, `.jpg` or `.png`, or of a text file that holds its address.
///
/// # Errors
/// Names the file and what is wrong with it.
pub fn read_file(path: &Path) -> Result<Vec<u8>> {
    let bytes = read_bytes(path)?;
    match std::str::from_utf8(&bytes) {
        Ok(text) if text.starts_with("data:") => {
            bytes_of_address(text.trim_end()).map_err(|e| Error::content(path, e.to_string()))
        }
        _ => Ok(bytes),
    }
}

/// The bytes of the picture in an address.
///
/// # Errors
/// [`ReadPhotographError`].
pub fn bytes_of_address(text: &str) -> Result<Vec<u8>, ReadPhotographError> {
    Ok(STANDARD.decode(encoded(text)?.1)?)
}

/// The picture in an address.
///
/// # Errors
/// [`ReadPhotographError`].
pub fn of_address(text: &str) -> Result<Photograph, ReadPhotographError> {
    let (format, encoded) = encoded(text)?;
    let picture = of_bytes(STANDARD.decode(encoded)?)?;
    match picture.format() == format {
        true => Ok(picture),
        false => Err(ReadPhotographError::Format),
    }
}

/// The format that an address names, and its base64.
fn encoded(text: &str) -> Result<(PhotographFormat, &str), ReadPhotographError> {
    let begin = |format| text.strip_prefix(head(format));
    [PhotographFormat::Jpeg, PhotographFormat::Png]
        .into_iter()
        .find_map(|format| Some((format, begin(format)?)))
        .ok_or_else(|| ReadPhotographError::Address(text.chars().take(40).collect()))
}

/// The address of a picture.
pub fn address(picture: &Photograph) -> String {
    let mut text = head(picture.format()).to_owned();
    STANDARD.encode_string(picture.bytes(), &mut text);
    text
}

/// The address of a picture's bytes, whatever its size.
pub fn address_of_bytes(bytes: &[u8]) -> String {
    let is_png = bytes.starts_with(b"\x89PNG");
    let format = if is_png {
        PhotographFormat::Png
    } else {
        PhotographFormat::Jpeg
    };
    let mut text = head(format).to_owned();
    STANDARD.encode_string(bytes, &mut text);
    text
}

/// The beginning of the data address, before the picture.
fn head(format: PhotographFormat) -> &'static str {
    match format {
        PhotographFormat::Jpeg => "data:image/jpeg;base64,",
        PhotographFormat::Png => "data:image/png;base64,",
    }
}
