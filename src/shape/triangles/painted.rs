//! The painted surface of a building: triangles with a texture or a plain colour.

use std::sync::Arc;

/// The paint of a triangle.
#[derive(Debug, PartialEq)]
pub enum Surface {
    /// One colour: red, green, blue.
    Plain([u8; 3]),
    /// A picture.
    Texture(Texture),
}

/// A picture.
#[derive(Debug, PartialEq)]
pub struct Texture {
    /// File name.
    pub name: String,
    /// Columns.
    pub width: usize,
    /// Red, green, blue, row after row from the top.
    pub colours: Vec<[u8; 3]>,
    /// The file as it is: a PNG, JPEG or WebP.
    pub file: Arc<[u8]>,
}

impl Texture {
    /// Rows.
    pub fn height(&self) -> usize {
        self.colours.len() / self.width.max(1)
    }

    /// The colour at texture coordinates: u to the right, v upwards, 0 to 1; repeated beyond.
    pub fn at(&self, [u, v]: [f64; 2]) -> [u8; 3] {
        let (w, h) = (self.width, self.height());
        let along = |t: f64, n: usize| ((t.rem_euclid(1.0) * n as f64) as usize).min(n - 1);
        self.colours[along(1.0 - v, h) * w + along(u, w)]
    }
}

/// The grey of a colour (ITU-R BT.601), 0 to 255.
pub fn grey([r, g, b]: [u8; 3]) -> u8 {
    let [r, g, b] = [r, g, b].map(u32::from);
    ((299 * r + 587 * g + 114 * b + 500) / 1000) as u8
}

/// A triangle with its looks.
#[derive(Debug, Clone, PartialEq)]
pub struct Painted {
    /// Corners in metres.
    pub corners: [[f64; 3]; 3],
    /// Texture coordinates of the corners.
    pub uv: [[f64; 2]; 3],
    /// Its paint.
    pub surface: Arc<Surface>,
}

/// Most pieces of a triangle.
const MOST_PIECES: usize = 262_144;

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
        area * texture.colours.len() as f64
    }

    /// It in pieces, whose longest edges are at most `most` metres, by halving longest edges; in at most 262,144 pieces.
    pub fn pieces(&self, most: f64) -> Vec<Self> {
        let mut open = vec![self.clone()];
        let mut out = Vec::new();
        while let Some(piece) = open.pop() {
            let ends = |k: usize| (piece.corners[k], piece.corners[(k + 1) % 3]);
            let length = |k: usize| {
                let (a, b) = ends(k);
                (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>()
            };
            let k = (1..3).fold(0, |best, k| if length(k) > length(best) { k } else { best });
            // Not so for what is not a number.
            let long = length(k) > most * most;
            if !long || open.len() + out.len() >= MOST_PIECES {
                out.push(piece);
                continue;
            }
            let (i, j) = (k, (k + 1) % 3);
            let middle = [0, 1, 2].map(|c| (piece.corners[i][c] + piece.corners[j][c]) / 2.0);
            let uv = [0, 1].map(|c| (piece.uv[i][c] + piece.uv[j][c]) / 2.0);
            for replaced in [i, j] {
                let mut half = piece.clone();
                (half.corners[replaced], half.uv[replaced]) = (middle, uv);
                open.push(half);
            }
        }
        out
    }

    /// Length of its longest edge in metres.
    pub fn longest(&self) -> f64 {
        let [a, b, c] = self.corners;
        let length = |p: [f64; 3], q: [f64; 3]| {
            let square = |k: usize| (p[k] - q[k]).powi(2);
            (0..3).map(square).sum::<f64>().sqrt()
        };
        length(a, b).max(length(b, c)).max(length(c, a))
    }

    /// Turns its front to the back.
    pub fn flip(&mut self) {
        self.corners.swap(1, 2);
        self.uv.swap(1, 2);
    }

    /// Its colour where the corners have these weights.
    pub fn colour(&self, weights: [f64; 3]) -> [u8; 3] {
        match &*self.surface {
            Surface::Plain(colour) => *colour,
            Surface::Texture(texture) => {
                texture.at([0, 1].map(|c| (0..3).map(|k| weights[k] * self.uv[k][c]).sum::<f64>()))
            }
        }
    }

    /// Area in square metres.
    pub fn area(&self) -> f64 {
        let [a, b, c] = self.corners;
        let edge = |q: [f64; 3]| [0, 1, 2].map(|k| q[k] - a[k]);
        let ([ux, uy, uz], [vx, vy, vz]) = (edge(b), edge(c));
        let n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
        n.iter().map(|v| v * v).sum::<f64>().sqrt() / 2.0
    }
}

/// The corners of a triangle bit by bit: what tells a painted triangle from others of its building.
pub fn corner_bits(corners: [[f64; 3]; 3]) -> [[u64; 3]; 3] {
    corners.map(|p| p.map(f64::to_bits))
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
            surface: Arc::new(Surface::Plain([0; 3])),
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
    fn pieces_are_small_and_cover_the_whole() {
        let whole = Painted {
            corners: [[0.0, 0.0, 0.0], [7.0, 1.0, 0.0], [2.0, 5.0, 3.0]],
            uv: [[0.0, 0.0], [7.0, 1.0], [2.0, 5.0]],
            surface: Arc::new(Surface::Plain([0; 3])),
        };
        let pieces = whole.pieces(0.7);
        let area: f64 = pieces.iter().map(Painted::area).sum();
        assert!((area - whole.area()).abs() < 1e-9 && pieces.len() > 80);
        for piece in &pieces {
            for k in 0..3 {
                let (a, b) = (piece.corners[k], piece.corners[(k + 1) % 3]);
                let edge: f64 = (0..3).map(|i| (a[i] - b[i]).powi(2)).sum();
                assert!(edge <= 0.49);
                assert!((0..2).all(|c| (piece.uv[k][c] - a[c]).abs() < 1e-9));
            }
        }
        assert_eq!(whole.pieces(10.0), [whole]);
    }

    #[test]
    fn texture_coordinates_go_up_and_repeat() {
        let texture = Texture {
            name: String::new(),
            width: 2,
            colours: [1, 2, 3, 4].map(|v| [v; 3]).to_vec(),
            file: Arc::new([]),
        };
        assert_eq!(texture.at([0.2, 0.8]), [1; 3]);
        assert_eq!(texture.at([0.7, 0.2]), [4; 3]);
        assert_eq!(texture.at([1.2, -0.2]), [1; 3]);
        assert_eq!(texture.at([1.0, 1.0]), texture.at([0.0, 0.0]));
    }
}
