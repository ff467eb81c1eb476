//! The area of horizontal sections.
//!
//! For a mesh whose triangles face outwards, A(z) is the sum of the signed plan areas of the triangle
//! parts above z: the closed surface above z, with the section as its bottom, has no net plan area. The
//! bottom face of the mesh does not enter, and vertical walls contribute nothing.

use super::mesh::plan_area;
use super::{Corners, TriangleMesh};

/// A(z) at the heights `base`, `base + step`, ..., and the exact heights of horizontal faces.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionProfile {
    /// Lowest height.
    pub base: f64,
    /// Highest height.
    pub top: f64,
    /// Distance of the samples.
    pub step: f64,
    /// A(base + i step), in square metres.
    pub areas: Vec<f64>,
    /// Height and signed plan area of every horizontal face, by height.
    pub faces: Vec<(f64, f64)>,
}

impl SectionProfile {
    /// Samples A(z) every `step` from the lowest to beyond the highest position; at most `most` samples.
    /// `None` for a mesh without triangles or one that is higher than `most` steps.
    ///
    /// Costs O(triangles + steps crossed by slanted triangles).
    pub fn new(mesh: &TriangleMesh, step: f64, most: usize) -> Option<Self> {
        let (low, high) = mesh.bounds()?;
        let (base, top) = (low[2], high[2]);
        let steps = ((top - base) / step).ceil() + 2.0;
        if steps > most as f64 {
            return None;
        }
        let mut areas = vec![0.0; steps as usize];
        // Whole triangles count at all samples below them: added at their last, summed downwards.
        let mut whole = vec![0.0; steps as usize + 1];
        let mut faces = Vec::new();
        for t in mesh.corners() {
            let area = plan_area(&t);
            if area == 0.0 {
                continue;
            }
            let (zl, zh) = extent(&t);
            if zh - zl < 1e-6 {
                faces.push((zl, area));
            }
            // Samples at or below the lowest corner lie below the whole triangle. A face counts at
            // samples strictly below it: A is continuous from above, A(top) = 0.
            let first = ((zl - base) / step).ceil().max(0.0) as usize;
            whole[first] += area;
            let mut i = first;
            while i < areas.len() && base + i as f64 * step < zh {
                areas[i] += area * share_above(&t, base + i as f64 * step);
                i += 1;
            }
        }
        let mut above = 0.0;
        for i in (0..areas.len()).rev() {
            above += whole[i + 1];
            areas[i] += above;
        }
        faces.sort_by(|a, b| a.0.total_cmp(&b.0));
        Some(Self {
            base,
            top,
            step,
            areas,
            faces,
        })
    }
}

/// Lowest and highest corner.
pub(super) fn extent(t: &Corners) -> (f64, f64) {
    let z = [t[0][2], t[1][2], t[2][2]];
    let low = z[0].min(z[1]).min(z[2]);
    (low, z[0].max(z[1]).max(z[2]))
}

/// Share of a triangle's area strictly above `z`, exact.
fn share_above(t: &Corners, z: f64) -> f64 {
    let mut h = [t[0][2], t[1][2], t[2][2]];
    h.sort_by(f64::total_cmp);
    let [a, b, c] = h;
    if z >= c {
        0.0
    } else if z < a {
        1.0
    } else if z >= b {
        // The small triangle at the top.
        (c - z) * (c - z) / ((c - a) * (c - b))
    } else {
        1.0 - (z - a) * (z - a) / ((c - a) * (b - a))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_has_quadratic_sections() {
        let p = [
            [0.0, 0.0, 0.0],
            [3.0, 0.0, 0.0],
            [0.0, 3.0, 0.0],
            [0.0, 0.0, 3.0],
        ];
        let mesh = TriangleMesh {
            positions: p.to_vec(),
            triangles: vec![[0, 1, 3], [1, 2, 3], [2, 0, 3]],
        };
        let profile = SectionProfile::new(&mesh, 0.25, 100).unwrap();
        for (i, area) in profile.areas.iter().enumerate() {
            let z = 0.25 * i as f64;
            let side = (3.0 - z).max(0.0);
            assert!((area - side * side / 2.0).abs() < 1e-12, "A({z}) = {area}");
        }
    }

    #[test]
    fn shares_are_those_of_the_parts_that_a_plane_cuts() {
        let mut next = edifice_base::rng::stream(4, "shares", 0);
        let mut number = || rand::RngExt::random_range(&mut next, -2.0..2.0);
        for _ in 0..2000 {
            let t: Corners = std::array::from_fn(|_| std::array::from_fn(|_| number()));
            let z = number();
            let mut mesh = TriangleMesh::default();
            mesh.push(t);
            let [below, above] = &super::super::clip_to_slabs(&mesh, &[z])[..] else {
                panic!("two parts");
            };
            let whole = mesh.area();
            assert!((below.area() + above.area() - whole).abs() < 1e-9 * (1.0 + whole));
            let share = share_above(&t, z);
            assert!((above.area() - share * whole).abs() < 1e-4, "{t:?} {z}");
        }
    }
}
