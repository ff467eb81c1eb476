//! A photograph of a facade as the rectangle that its four corners enclose.

use std::io::Cursor;

use image::codecs::jpeg::JpegEncoder;
use image::{DynamicImage, ImageDecoder, ImageReader, RgbImage};
use rayon::prelude::*;

use super::{ReadPhotographError, of_bytes};
use edifice_shape::Photograph;
use edifice_shape::rectification::{Corners, CornersError, Pixel};

/// Longest side of the rectangle in pixels.
const LONGEST: u32 = 1400;
/// Quality of its JPEG file, of 100.
const QUALITY: u8 = 88;
/// Samples of a pixel along each side.
const SAMPLES: u32 = 2;
/// Most pixels of a photograph along a side, and most bytes that it takes in memory.
const MOST: (u32, u64) = (20_000, 1 << 30);

/// Why a photograph is not straightened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StraightenError {
    /// It cannot be read, or the rectangle cannot be written.
    #[error(transparent)]
    Picture(#[from] ReadPhotographError),
    /// The corners are not those of a rectangle.
    #[error(transparent)]
    Corners(#[from] CornersError),
    /// Width over height is no positive number, or far from what a facade has.
    #[error("width over height of {0}: expected 1/50 to 50")]
    Aspect(f64),
}

/// A photograph that was read, the way up that its camera noted.
pub struct Picture(RgbImage);

impl Picture {
    /// Reads a JPEG or PNG file.
    ///
    /// # Errors
    /// [`ReadPhotographError`].
    pub fn of_bytes(bytes: &[u8]) -> Result<Self, ReadPhotographError> {
        let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
        let mut reader = reader.map_err(image::ImageError::IoError)?;
        if super::format(&reader).is_none() {
            return Err(ReadPhotographError::Format);
        }
        let mut limits = image::Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(MOST.0), Some(MOST.0));
        limits.max_alloc = Some(MOST.1);
        reader.limits(limits);
        let mut decoder = reader.into_decoder()?;
        let way = decoder.orientation()?;
        let mut picture = DynamicImage::from_decoder(decoder)?;
        picture.apply_orientation(way);
        Ok(Self(picture.into_rgb8()))
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.0.width(), self.0.height()]
    }

    /// The rectangle inside four corners, with this width over height, as a JPEG file of at most 1,400 pixels a side.
    ///
    /// # Errors
    /// [`StraightenError`].
    pub fn straightened(
        &self,
        corners: &Corners,
        aspect: f64,
    ) -> Result<Photograph, StraightenError> {
        if !(0.02..=50.0).contains(&aspect) {
            return Err(StraightenError::Aspect(aspect));
        }
        let longest = f64::from(LONGEST);
        let [width, height] = match aspect >= 1.0 {
            true => [longest, longest / aspect],
            false => [longest * aspect, longest],
        };
        let [width, height] = [width, height].map(|v| v.round() as u32);
        let map = corners.map();
        let steps = SAMPLES;
        let share = |k: u32, step: u32, of: u32| {
            (f64::from(k) + (f64::from(step) + 0.5) / f64::from(steps)) / f64::from(of)
        };
        let pixel = |x: u32, y: u32| {
            let samples = (0..steps * steps).map(|s| {
                let place = map.at([share(x, s % steps, width), share(y, s / steps, height)]);
                self.at(place)
            });
            let sum = samples.fold([0.0; 3], |a, b| [0, 1, 2].map(|c| a[c] + b[c]));
            sum.map(|v| (v / f64::from(steps * steps)).round() as u8)
        };
        let mut out = RgbImage::new(width, height);
        let rows = out.par_chunks_exact_mut(3 * width as usize).enumerate();
        rows.for_each(|(y, row)| {
            for (x, p) in row.chunks_exact_mut(3).enumerate() {
                p.copy_from_slice(&pixel(x as u32, y as u32));
            }
        });
        let mut file = Vec::new();
        JpegEncoder::new_with_quality(&mut file, QUALITY)
            .encode_image(&out)
            .map_err(ReadPhotographError::Picture)?;
        Ok(of_bytes(file)?)
    }

    /// The colour at a place, bilinear; outside it is that of the nearest pixel.
    fn at(&self, [x, y]: Pixel) -> [f64; 3] {
        let [width, height] = self.size().map(f64::from);
        let u = (x - 0.5).clamp(0.0, width - 1.0);
        let v = (y - 0.5).clamp(0.0, height - 1.0);
        let [i, j] = [u, v].map(|t| t.floor());
        let [a, b] = [u - i, v - j];
        let pixel = |dx: f64, dy: f64| {
            let [x, y] = [(i + dx).min(width - 1.0), (j + dy).min(height - 1.0)];
            self.0.get_pixel(x as u32, y as u32).0.map(f64::from)
        };
        let [p, q, r, s] = [
            pixel(0.0, 0.0),
            pixel(1.0, 0.0),
            pixel(0.0, 1.0),
            pixel(1.0, 1.0),
        ];
        [0, 1, 2]
            .map(|c| (1.0 - b) * ((1.0 - a) * p[c] + a * q[c]) + b * ((1.0 - a) * r[c] + a * s[c]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    /// A wall with a dark square in each quarter but the lower right one, as a file.
    fn wall(width: u32, height: u32) -> Vec<u8> {
        let dark = |x: u32, y: u32| {
            let [u, v] = [
                f64::from(x) / f64::from(width),
                f64::from(y) / f64::from(height),
            ];
            let near = |a: f64| (a - 0.25).abs() < 0.1 || (a - 0.75).abs() < 0.1;
            near(u) && near(v) && !(u > 0.5 && v > 0.5)
        };
        let picture = RgbImage::from_fn(width, height, |x, y| match dark(x, y) {
            true => Rgb([30, 40, 50]),
            false => Rgb([220, 200, 180]),
        });
        let mut bytes = Cursor::new(Vec::new());
        picture
            .write_to(&mut bytes, image::ImageFormat::Png)
            .expect("written");
        bytes.into_inner()
    }

    fn grey(picture: &Photograph, u: f64, v: f64) -> f64 {
        let read = image::load_from_memory(picture.bytes())
            .expect("a picture")
            .into_luma8();
        let [w, h] = [read.width(), read.height()].map(f64::from);
        f64::from(read.get_pixel((u * w) as u32, (v * h) as u32).0[0])
    }

    #[test]
    fn a_whole_picture_keeps_its_content() {
        let picture = Picture::of_bytes(&wall(600, 400)).expect("read");
        let corners = Corners::whole(picture.size()).expect("corners");
        let made = picture.straightened(&corners, 1.5).expect("made");
        assert_eq!(made.size(), [1400, 933]);
        for (u, v, dark) in [
            (0.25, 0.25, true),
            (0.75, 0.25, true),
            (0.25, 0.75, true),
            (0.75, 0.75, false),
            (0.5, 0.5, false),
        ] {
            assert_eq!(grey(&made, u, v) < 100.0, dark, "{u} {v}");
        }
    }

    #[test]
    fn corners_inside_become_the_whole() {
        let picture = Picture::of_bytes(&wall(600, 400)).expect("read");
        // The upper left quarter.
        let corners = Corners::new([[0.0, 0.0], [300.0, 0.0], [300.0, 200.0], [0.0, 200.0]]);
        let made = picture
            .straightened(&corners.expect("corners"), 0.5)
            .expect("made");
        assert_eq!(made.size(), [700, 1400]);
        assert!(grey(&made, 0.5, 0.5) < 100.0);
        assert!(grey(&made, 0.1, 0.1) > 100.0 && grey(&made, 0.9, 0.9) > 100.0);
    }

    #[test]
    fn bad_pictures_and_shapes_are_refused() {
        assert!(Picture::of_bytes(b"no picture").is_err());
        assert!(Picture::of_bytes(&wall(60, 40)[..200]).is_err());
        let picture = Picture::of_bytes(&wall(60, 40)).expect("read");
        let corners = Corners::whole(picture.size()).expect("corners");
        for aspect in [0.0, -1.0, f64::NAN, f64::INFINITY, 51.0] {
            assert!(picture.straightened(&corners, aspect).is_err(), "{aspect}");
        }
    }
}
