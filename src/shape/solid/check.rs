//! Checks that a surface is closed, without knowledge of its making.

use rustc_hash::FxHashMap;

use super::Surface;

/// The size of a sound surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// Distinct corners.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// Connected parts of the surface.
    pub shells: usize,
    /// Enclosed volume.
    pub volume: f64,
}

/// The defects of a surface.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// It has no triangles.
    #[error("the surface has no triangles")]
    Empty,
    /// A triangle names a corner that does not exist, or is not finite.
    #[error("triangle {triangle} has a corner that does not exist or is not finite")]
    Corner {
        /// Index of the triangle.
        triangle: usize,
    },
    /// Two corners of a triangle are one point.
    #[error("triangle {triangle} has two corners in one point")]
    Degenerate {
        /// Index of the triangle.
        triangle: usize,
    },
    /// Two triangles have the same edge in the same direction.
    #[error("an edge at ({}, {}, {}) is passed twice in one direction: parts touch in a line or overlap", at[0], at[1], at[2])]
    Twice {
        /// The start of the edge.
        at: [f64; 3],
    },
    /// An edge has one triangle only.
    #[error("the surface is open at ({}, {}, {})", at[0], at[1], at[2])]
    Open {
        /// The start of the edge.
        at: [f64; 3],
    },
    /// A face has no proper outline.
    #[error("a face at ({}, {}, {}) touches itself", corner[0], corner[1], corner[2])]
    Face {
        /// One of its corners.
        corner: [f64; 3],
    },
}

impl Surface {
    /// The surface without its enclosed hollows (shells of negative volume), and their volume: corners under eaves
    /// that nothing reaches are solid.
    #[must_use]
    pub fn filled(self) -> (Self, f64) {
        let mut owner: FxHashMap<(u32, u32), usize> = FxHashMap::default();
        for (k, (t, _)) in self.triangles.iter().enumerate() {
            for i in 0..3 {
                owner.insert((t[i], t[(i + 1) % 3]), k);
            }
        }
        let mut parent: Vec<usize> = (0..self.triangles.len()).collect();
        for (&(v, w), &k) in &owner {
            if let Some(&other) = owner.get(&(w, v)) {
                let (a, b) = (root(&mut parent, k), root(&mut parent, other));
                parent[a.max(b)] = a.min(b);
            }
        }
        let mut volumes: FxHashMap<usize, f64> = FxHashMap::default();
        let shells: Vec<usize> = (0..parent.len()).map(|k| root(&mut parent, k)).collect();
        for ((t, _), shell) in self.triangles.iter().zip(&shells) {
            let corners = t.map(|v| self.positions[v as usize]);
            *volumes.entry(*shell).or_default() += tetrahedron(corners, self.positions[0]);
        }
        let mut hollow = 0.0;
        let mut kept: Vec<usize> = volumes.keys().copied().collect();
        kept.sort_unstable();
        for shell in &kept {
            hollow += (-volumes[shell]).max(0.0);
        }
        let triangles = self.triangles.iter().zip(&shells);
        let triangles = triangles.filter(|(_, shell)| volumes[shell] > 0.0);
        let triangles = triangles.map(|(t, _)| *t).collect();
        let surface = Self {
            positions: self.positions,
            triangles,
        };
        (surface, hollow)
    }

    /// Checks that each directed edge occurs once and its twin once, corners being told apart by their
    /// coordinates, and measures the surface.
    ///
    /// # Errors
    /// [`SurfaceError`] with the place of the first fault.
    pub fn check(&self) -> Result<Report, SurfaceError> {
        if self.triangles.is_empty() {
            return Err(SurfaceError::Empty);
        }
        let mut number: FxHashMap<[u64; 3], u32> = FxHashMap::default();
        // Adding zero makes one of the two zeros.
        let mut vertex = |p: [f64; 3]| {
            let next = number.len() as u32;
            *number.entry(p.map(|v| (v + 0.0).to_bits())).or_insert(next)
        };
        let mut edges: FxHashMap<(u32, u32), usize> = FxHashMap::default();
        let mut volume = 0.0;
        let middle = self.positions[0];
        for (k, (triangle, _)) in self.triangles.iter().enumerate() {
            let mut corners = [[0.0; 3]; 3];
            for (corner, &v) in corners.iter_mut().zip(triangle) {
                let known = self.positions.get(v as usize);
                let known = known.filter(|p| p.iter().all(|v| v.is_finite()));
                *corner = *known.ok_or(SurfaceError::Corner { triangle: k })?;
            }
            let v = corners.map(&mut vertex);
            if v[0] == v[1] || v[1] == v[2] || v[2] == v[0] {
                return Err(SurfaceError::Degenerate { triangle: k });
            }
            for i in 0..3 {
                if edges.insert((v[i], v[(i + 1) % 3]), k).is_some() {
                    return Err(SurfaceError::Twice { at: corners[i] });
                }
            }
            volume += tetrahedron(corners, middle);
        }
        let mut parent: Vec<usize> = (0..self.triangles.len()).collect();
        let mut shells = parent.len();
        for (&(v, w), &k) in &edges {
            let Some(&other) = edges.get(&(w, v)) else {
                let open = self.triangles[k].0.map(|i| self.positions[i as usize]);
                return Err(SurfaceError::Open { at: open[0] });
            };
            let (a, b) = (root(&mut parent, k), root(&mut parent, other));
            shells -= usize::from(a != b);
            parent[a] = b;
        }
        Ok(Report {
            vertices: number.len(),
            triangles: self.triangles.len(),
            shells,
            volume,
        })
    }
}

/// Signed volume between a triangle and a point.
fn tetrahedron(corners: [[f64; 3]; 3], point: [f64; 3]) -> f64 {
    let [a, b, c] = corners.map(|p| [0, 1, 2].map(|i| p[i] - point[i]));
    (a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0]))
        / 6.0
}

fn root(parent: &mut [usize], mut k: usize) -> usize {
    while parent[k] != k {
        parent[k] = parent[parent[k]];
        k = parent[k];
    }
    k
}
