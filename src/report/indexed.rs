//! PNG files of at most 256 colours: half as large as others, and figures look the same.

use std::collections::HashMap;

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

    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_palette(palette.concat());
    encoder.set_filter(png::Filter::NoFilter);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&indices)?;
    writer.finish()?;
    Ok(bytes)
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
}
