//! The rectangle of a facade from its four corners in a photograph.
//!
//! # Deviations and readings
//! - Zhang and He, "Whiteboard scanning and image enhancement" (Digital Signal Processing 17, 2007): square pixels, the optical
//!   axis through the middle of the picture. The focal length follows from both vanishing points, the aspect ratio from it.
//! - Where one pair of sides is parallel in the picture (a camera held level), the two say nothing of the focal length: any focal
//!   length fits one aspect ratio each. It is then [`USUAL_FOCAL`]; a picture that was cut has another middle, too.

/// The focal length that is assumed where the corners do not tell it, in longer sides of the picture: that of a phone's camera.
pub const USUAL_FOCAL: f64 = 0.75;
/// Focal lengths that a camera has, in longer sides of the picture; others are noise of nearly parallel sides.
const FOCALS: [f64; 2] = [0.35, 8.0];
/// Sides whose vanishing point is this many times the focal length away and more are parallel.
const PARALLEL: f64 = 25.0;

/// A place in a picture, in pixels from its upper left corner, y down.
pub type Pixel = [f64; 2];

/// The four corners of a rectangle in a picture: upper left, upper right, lower right, lower left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corners([Pixel; 4]);

/// Why four places are not the corners of a rectangle in a photograph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CornersError {
    /// A coordinate is no finite number.
    #[error("a corner is no place: expected finite numbers of pixels")]
    Finite,
    /// They do not go round a convex area.
    #[error(
        "the corners are not those of a rectangle seen from its front: expected upper left, upper right, lower right, lower left"
    )]
    Convex,
}

impl Corners {
    /// Corners in this order: upper left, upper right, lower right, lower left, in pixels, y down.
    ///
    /// # Errors
    /// [`CornersError`], unless they go round a convex area clockwise as seen in the picture.
    pub fn new(places: [Pixel; 4]) -> Result<Self, CornersError> {
        if !places.iter().flatten().all(|v| v.is_finite()) {
            return Err(CornersError::Finite);
        }
        // Twice the area of the smallest triangle of three neighbours, at least that of a square pixel.
        let convex = (0..4).all(|k| {
            let [a, b, c] = [0, 1, 2].map(|d| places[(k + d) % 4]);
            (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]) >= 1.0
        });
        match convex {
            true => Ok(Self(places)),
            false => Err(CornersError::Convex),
        }
    }

    /// The corners of a whole picture of this size in pixels.
    ///
    /// # Errors
    /// [`CornersError::Convex`] for a picture without area.
    pub fn whole([width, height]: [u32; 2]) -> Result<Self, CornersError> {
        let [w, h] = [width, height].map(f64::from);
        Self::new([[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]])
    }

    /// The projective map from the unit square, (0, 0) its upper left corner, to the picture (Heckbert 1989, "Fundamentals of
    /// texture mapping and image warping", Sec. 2.2.3).
    pub fn map(&self) -> ProjectiveMap {
        let [p0, p1, p2, p3] = self.0;
        let [d1, d2] = [p1, p3].map(|p| [p[0] - p2[0], p[1] - p2[1]]);
        let sum = [0, 1].map(|k| p0[k] - p1[k] + p2[k] - p3[k]);
        let area = d1[0] * d2[1] - d2[0] * d1[1];
        let g = (sum[0] * d2[1] - d2[0] * sum[1]) / area;
        let h = (d1[0] * sum[1] - sum[0] * d1[1]) / area;
        let row = |k: usize| [p1[k] - p0[k] + g * p1[k], p3[k] - p0[k] + h * p3[k], p0[k]];
        ProjectiveMap([row(0), row(1), [g, h, 1.0]])
    }

    /// Width over height of the rectangle, from a picture of this size in pixels.
    pub fn aspect(&self, [width, height]: [u32; 2]) -> f64 {
        let longest = f64::from(width.max(height));
        let middle = [width, height].map(|v| f64::from(v) / 2.0);
        // The sides of the rectangle as directions in space, up to one factor, are columns of the map seen from the middle, in longer
        // sides of the picture (n2 and n3 of the paper).
        let map = self.map().0;
        let column = |c: usize| {
            let w = map[2][c];
            let [x, y] = [0, 1].map(|k| (map[k][c] - middle[k] * w) / longest);
            [x, y, w]
        };
        let [across, down] = [column(0), column(1)];
        let flat = |n: [f64; 3]| (n[0] * n[0] + n[1] * n[1]).sqrt();
        let is_seen = |n: [f64; 3]| n[2].abs() * PARALLEL > flat(n);
        let focal = match is_seen(across) && is_seen(down) {
            // They are perpendicular in space.
            true => -(across[0] * down[0] + across[1] * down[1]) / (across[2] * down[2]),
            false => USUAL_FOCAL * USUAL_FOCAL,
        };
        let [least, most] = FOCALS;
        let focal = match (least * least..=most * most).contains(&focal) {
            true => focal,
            false => USUAL_FOCAL * USUAL_FOCAL,
        };
        let length = |n: [f64; 3]| (n[0] * n[0] + n[1] * n[1] + n[2] * n[2] * focal).sqrt();
        length(across) / length(down)
    }
}

/// A projective map of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProjectiveMap([[f64; 3]; 3]);

impl ProjectiveMap {
    /// The place that a point is taken to.
    pub fn at(&self, [u, v]: [f64; 2]) -> Pixel {
        let [x, y, w] = self.0.map(|r| r[0] * u + r[1] * v + r[2]);
        [x / w, y / w]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::StdRng};

    type Turn = [[f64; 3]; 3];

    fn product(a: Turn, b: Turn) -> Turn {
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
    }

    /// The corners of a rectangle of this size, whose middle is `far` before a camera turned by yaw, pitch and roll; focal length
    /// in longer sides.
    fn seen(
        [w, h]: [f64; 2],
        [yaw, pitch, roll]: [f64; 3],
        far: f64,
        focal: f64,
        picture: [u32; 2],
    ) -> [Pixel; 4] {
        let [sy, cy] = [yaw.sin(), yaw.cos()];
        let [sp, cp] = [pitch.sin(), pitch.cos()];
        let [sr, cr] = [roll.sin(), roll.cos()];
        let turn = product(
            [[cr, -sr, 0.0], [sr, cr, 0.0], [0.0, 0.0, 1.0]],
            product(
                [[1.0, 0.0, 0.0], [0.0, cp, -sp], [0.0, sp, cp]],
                [[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]],
            ),
        );
        let longest = f64::from(picture[0].max(picture[1]));
        let [x, y] = [w / 2.0, h / 2.0];
        [[-x, -y], [x, -y], [x, y], [-x, y]].map(|[x, y]| {
            let p = turn.map(|r| r[0] * x + r[1] * y);
            let depth = p[2] + far;
            [0, 1].map(|k| p[k] / depth * focal * longest + f64::from(picture[k]) / 2.0)
        })
    }

    #[test]
    fn the_aspect_of_ten_pictures_of_known_cameras() {
        let cameras: [([f64; 2], [f64; 3], f64); 10] = [
            ([12.0, 9.0], [0.5, 0.2, 0.0], 0.72),
            ([9.0, 12.0], [-0.4, 0.3, 0.0], 0.72),
            ([20.0, 8.0], [0.6, 0.25, 0.02], 0.75),
            ([6.0, 18.0], [0.3, 0.5, -0.03], 0.7),
            ([15.0, 15.0], [-0.7, 0.15, 0.01], 1.0),
            ([30.0, 10.0], [0.35, 0.2, 0.0], 0.5),
            ([10.0, 14.0], [0.2, 0.4, 0.05], 1.4),
            ([14.0, 11.0], [-0.5, -0.2, 0.0], 0.9),
            ([8.0, 8.0], [0.8, 0.3, 0.0], 0.72),
            ([18.0, 12.0], [-0.3, 0.35, -0.02], 2.0),
        ];
        for (size, turn, focal) in cameras {
            let picture = [4000, 3000];
            let far = 1.6 * size[0].max(size[1]) * focal.max(0.7);
            // As exact as a person puts a corner: on whole pixels.
            let places = seen(size, turn, far, focal, picture).map(|p| p.map(f64::round));
            let corners = Corners::new(places).expect("seen from its front");
            let [found, truth] = [corners.aspect(picture), size[0] / size[1]];
            assert!(
                (found / truth - 1.0).abs() < 0.05,
                "{size:?} {turn:?}: {found} of {truth}"
            );
        }
    }

    /// Exact corners give the exact aspect ratio: 2,000 random cameras, all with both vanishing points.
    #[test]
    fn exact_corners_give_the_exact_aspect() {
        let stream = &mut StdRng::seed_from_u64(3);
        let mut tried = 0;
        while tried < 2000 {
            let mut between = |a: f64, b: f64| a + (b - a) * stream.random::<f64>();
            let size = [between(3.0, 30.0), between(3.0, 30.0)];
            let sign = |v: f64| if v < 0.5 { -1.0 } else { 1.0 };
            let yaw = sign(between(0.0, 1.0)) * between(0.25, 0.9);
            let pitch = sign(between(0.0, 1.0)) * between(0.25, 0.6);
            let focal = between(0.5, 2.5);
            let far = between(1.2, 3.0) * size[0].max(size[1]);
            let picture = [3000, 4000];
            let places = seen(size, [yaw, pitch, between(-0.1, 0.1)], far, focal, picture);
            let Ok(corners) = Corners::new(places) else {
                continue;
            };
            tried += 1;
            let found = corners.aspect(picture);
            assert!((found / (size[0] / size[1]) - 1.0).abs() < 1e-6, "{found}");
        }
    }

    #[test]
    fn a_picture_from_the_front_keeps_its_proportion() {
        let corners = Corners::new([[100.0, 50.0], [900.0, 50.0], [900.0, 450.0], [100.0, 450.0]]);
        assert!((corners.expect("a rectangle").aspect([1000, 600]) - 2.0).abs() < 1e-12);
        // A level camera that turned by .3 and has the usual focal length.
        let places = seen(
            [12.0, 9.0],
            [0.3, 0.0, 0.0],
            20.0,
            USUAL_FOCAL,
            [4000, 3000],
        );
        let found = Corners::new(places).expect("seen").aspect([4000, 3000]);
        assert!((found / (12.0 / 9.0) - 1.0).abs() < 1e-9, "{found}");
    }

    #[test]
    fn the_map_takes_the_unit_square_to_the_corners() {
        let stream = &mut StdRng::seed_from_u64(4);
        for _ in 0..2000 {
            let mut near = |x: f64, y: f64| {
                [
                    x + stream.random_range(-90.0..90.0),
                    y + stream.random_range(-90.0..90.0),
                ]
            };
            let places = [
                near(100.0, 100.0),
                near(500.0, 100.0),
                near(500.0, 400.0),
                near(100.0, 400.0),
            ];
            let Ok(corners) = Corners::new(places) else {
                continue;
            };
            let map = corners.map();
            for (from, to) in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
                .into_iter()
                .zip(places)
            {
                let at = map.at(from);
                assert!(
                    (0..2).all(|k| (at[k] - to[k]).abs() < 1e-6),
                    "{at:?} {to:?}"
                );
            }
        }
    }

    #[test]
    fn other_places_are_refused() {
        let bad = [
            [[0.0, 0.0], [0.0, 0.0], [9.0, 9.0], [0.0, 9.0]],
            [[0.0, 0.0], [0.0, 9.0], [9.0, 9.0], [9.0, 0.0]],
            [[0.0, 0.0], [9.0, 9.0], [9.0, 0.0], [0.0, 9.0]],
            [[0.0, 0.0], [9.0, 0.0], [3.0, 3.0], [0.0, 9.0]],
            [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]],
            [[f64::NAN, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]],
            [[0.0, 0.0], [f64::INFINITY, 0.0], [9.0, 9.0], [0.0, 9.0]],
        ];
        for places in bad {
            assert!(Corners::new(places).is_err(), "{places:?}");
        }
    }
}
