//! What the surface of a building looks like: triangles with a texture or a plain grey.

use std::sync::Arc;

/// What a triangle is painted with.
#[derive(Debug, PartialEq)]
pub enum Surface {
    /// One grey, from 0 (black) to 255.
    Plain(u8),
    /// A picture.
    Texture(Texture),
}

/// A picture in greys.
#[derive(Debug, PartialEq)]
pub struct Texture {
    /// File name.
    pub name: String,
    /// Columns.
    pub width: usize,
    /// Greys, row after row from the top.
    pub greys: Vec<u8>,
    /// Bytes of the file.
    pub bytes: usize,
}

impl Texture {
    /// Rows.
    pub fn height(&self) -> usize {
        self.greys.len() / self.width.max(1)
    }

    /// The grey at texture coordinates: u to the right, v upwards, 0 to 1; repeated beyond.
    pub fn at(&self, [u, v]: [f64; 2]) -> u8 {
        let (w, h) = (self.width, self.height());
        let along = |t: f64, n: usize| ((t.rem_euclid(1.0) * n as f64) as usize).min(n - 1);
        self.greys[along(1.0 - v, h) * w + along(u, w)]
    }
}

/// A triangle with its looks.
#[derive(Debug, Clone, PartialEq)]
pub struct Painted {
    /// Corners in metres.
    pub corners: [[f64; 3]; 3],
    /// Texture coordinates of the corners.
    pub uv: [[f64; 2]; 3],
    /// What it is painted with.
    pub surface: Arc<Surface>,
}

impl Painted {
    /// Share of the triangle's area between two heights.
    pub fn share_between(&self, low: f64, high: f64) -> f64 {
        let mut z = self.corners.map(|p| p[2]);
        z.sort_by(f64::total_cmp);
        below(z, high) - below(z, low)
    }

    /// Texels of its texture that it covers.
    pub fn texels(&self) -> f64 {
        let Surface::Texture(texture) = &*self.surface else {
            return 0.0;
        };
        let [a, b, c] = self.uv;
        let area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs() / 2.0;
        area * texture.greys.len() as f64
    }
}

/// Share of the area of a triangle below `t`, from the heights of its corners, increasing.
fn below([a, b, c]: [f64; 3], t: f64) -> f64 {
    if t <= a {
        0.0
    } else if t >= c {
        1.0
    } else if t < b {
        (t - a) * (t - a) / ((b - a) * (c - a))
    } else {
        1.0 - (c - t) * (c - t) / ((c - a) * (c - b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_slabs_add_up_and_are_those_of_the_definition() {
        let triangle = |z: [f64; 3]| Painted {
            corners: [[0.0, 0.0, z[0]], [1.0, 0.0, z[1]], [0.0, 1.0, z[2]]],
            uv: [[0.0; 2]; 3],
            surface: Arc::new(Surface::Plain(0)),
        };
        // Half of the height of a triangle that stands on its base: three quarters of the area.
        assert!((triangle([0.0, 0.0, 2.0]).share_between(0.0, 1.0) - 0.75).abs() < 1e-12);
        assert!((triangle([2.0, 0.0, 2.0]).share_between(0.0, 1.0) - 0.25).abs() < 1e-12);
        for z in [[0.0, 1.0, 3.0], [3.0, 1.0, 1.0], [2.0, 2.0, 2.0]] {
            let t = triangle(z);
            let sum: f64 = (0..8)
                .map(|k| t.share_between(0.5 * f64::from(k) - 0.3, 0.5 * f64::from(k) + 0.2))
                .sum();
            assert!((sum - 1.0).abs() < 1e-12, "{z:?} {sum}");
        }
    }

    #[test]
    fn texture_coordinates_go_up_and_repeat() {
        let texture = Texture {
            name: String::new(),
            width: 2,
            greys: vec![1, 2, 3, 4],
            bytes: 4,
        };
        assert_eq!(texture.at([0.2, 0.8]), 1);
        assert_eq!(texture.at([0.7, 0.2]), 4);
        assert_eq!(texture.at([1.2, -0.2]), 1);
        assert_eq!(texture.at([1.0, 1.0]), texture.at([0.0, 0.0]));
    }
}
