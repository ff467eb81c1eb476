//! Cut planes and components (Sec. IV.A and B).

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::component::{CELLS, Component};
use super::order::canonical_order;
use super::orientation::{half_turn, orient, upside_down};
use super::windows::window_features;
use edifice_base::{Ended, Progress, Watch, Watched};
use edifice_shape::triangles::{
    City, MeshFaults, OrientedBox, Painted, Part, SectionProfile, SideView, Surface, TriangleMesh,
    clip_to_slabs, closing_lid, grey, height_map, repair,
};

/// Step of A(z), in metres.
const STEP: f64 = 0.25;
/// Buildings below this height are differenced at [`FINE`] steps, others at [`COARSE`].
const LOW: f64 = 15.0;
/// Steps of a difference in low buildings: 0.5 m.
const FINE: usize = 2;
/// Steps of a difference in others: 1 m.
const COARSE: usize = 4;
/// Second difference that makes a cut, as a share of the largest area.
const THRESHOLD: f64 = 0.05;
/// Least height of a component, in metres.
const LEAST_HEIGHT: f64 = 2.0;
/// Most samples of A(z): 4 km.
const MOST_SAMPLES: usize = 16_000;
/// Cells along a side of the looks.
pub(crate) const LOOKS: usize = 4;
/// Pixels along a cell of the looks.
const DETAIL: usize = 8;
/// Columns per cell along a side.
pub(super) const SAMPLES: usize = 2;

/// All components of a city.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Decomposition {
    /// Components, building after building, from the ground up; the buildings by where and what they are, so that the order
    /// in which they are listed changes nothing.
    pub components: Vec<Component>,
    /// Faults of the mesh of each building.
    pub faults: Vec<MeshFaults>,
    /// Buildings without a component: no triangle has an area.
    pub empty: Vec<usize>,
    /// The way in which the cutting ended.
    pub ended: Ended,
}

/// Cuts every building of a city into components, on all threads. With `bottoms`, components are closed
/// below, too: their templates may stand on smaller ones, and a solid without a bottom reaches down to the ground.
///
/// `watch` is told of each building; those that come after it has stopped the work have no component, no fault, and are not
/// listed as empty.
pub fn decompose(city: &City, bottoms: bool, watch: &Watch) -> Decomposition {
    let watched = Watched::new(watch);
    let (done, most) = (AtomicU64::new(0), city.buildings.len() as u64);
    let order = canonical_order(city);
    let parts: Vec<Option<(Vec<Component>, MeshFaults)>> = order
        .par_iter()
        .map(|&b| {
            let done = done.fetch_add(1, Ordering::Relaxed);
            if !watched.goes_on(Progress::of("buildings", done, most)) {
                return None;
            }
            let building = &city.buildings[b];
            let (mesh, faults) = repair(&building.mesh);
            let mut components = match building.stated_parts() {
                Some(parts) => stated_components(parts, b),
                None => components_of(&mesh, b, bottoms),
            };
            for component in &mut components {
                component.look_at(&building.paint);
            }
            Some((components, faults))
        })
        .collect();
    let mut out = Decomposition {
        faults: vec![MeshFaults::default(); order.len()],
        ended: watched.ended(),
        ..Decomposition::default()
    };
    for (b, part) in order.into_iter().zip(parts) {
        let Some((components, faults)) = part else {
            continue;
        };
        if components.is_empty() {
            out.empty.push(b);
        }
        out.components.extend(components);
        out.faults[b] = faults;
    }
    out.empty.sort_unstable();
    out
}

impl Component {
    /// Sets window features, greys and texture from the paint of its building.
    fn look_at(&mut self, paint: &[Painted]) {
        let (low, high) = (self.frame.base[2], self.frame.base[2] + self.frame.size[2]);
        self.windows = window_features(paint, &self.frame);
        let bytes = |p: &Painted| match &*p.surface {
            Surface::Texture(t) => {
                let share = p.texels() * p.share_between(low, high);
                share * t.file.len() as f64 / t.colours.len().max(1) as f64
            }
            Surface::Plain(_) => 0.0,
        };
        // The sum of nothing is -0.
        self.texture_bytes = paint.iter().map(bytes).sum::<f64>() + 0.0;
        if self.texture_bytes > 0.0 {
            let sides = (0..4).map(|s| SideView::whole(paint, &self.frame, s, [DETAIL * LOOKS; 2]));
            self.looks = sides.flat_map(|side| blurred(&side)).collect();
        }
    }
}

/// The mean greys of [`LOOKS`] x [`LOOKS`] cells of a side; of one that is not painted, a middle grey.
fn blurred(side: &SideView) -> Vec<f32> {
    let cell = |c: usize| {
        let (x, y) = (c % LOOKS * DETAIL, c / LOOKS * DETAIL);
        let row = |j: usize| &side.colours[j * side.width + x..][..DETAIL];
        let own = (y..y + DETAIL).flat_map(row).flatten();
        let n = own.clone().count();
        let sum: f32 = own.map(|&c| f32::from(grey(c)) / 255.0).sum();
        if n == 0 { 0.5 } else { sum / n as f32 }
    };
    (0..LOOKS * LOOKS).map(cell).collect()
}

/// The components of a building of which the input says what it is put together from: nothing is cut.
fn stated_components(parts: Vec<(&Part, TriangleMesh)>, building: usize) -> Vec<Component> {
    let component = |(slab, (part, mesh)): (usize, (&Part, TriangleMesh))| Component {
        texture: part.texture.clone(),
        ..Component::of_template(mesh, part.frame, part.template, building, slab)
    };
    parts.into_iter().enumerate().map(component).collect()
}

impl Component {
    /// The template of number `stated`, with the mesh `mesh` in its unit box, in its place.
    pub(super) fn of_template(
        mesh: TriangleMesh,
        frame: OrientedBox,
        stated: usize,
        building: usize,
        slab: usize,
    ) -> Self {
        let heights = height_map(&mesh, CELLS, SAMPLES);
        Self {
            building,
            slab,
            frame,
            volume: (mesh.volume_above(0.0) * frame.volume()).max(0.0),
            symmetric: upside_down(&heights).is_none(),
            heights,
            mesh,
            stated: Some(stated),
            windows: None,
            looks: Vec::new(),
            texture_bytes: 0.0,
            texture: None,
        }
    }
}

/// The components of a repaired building.
fn components_of(mesh: &TriangleMesh, building: usize, bottoms: bool) -> Vec<Component> {
    let cuts = cut_planes(mesh);
    let mut components = Vec::new();
    let lids: Vec<TriangleMesh> = cuts.iter().map(|&z| closing_lid(mesh, z)).collect();
    for (slab, mut part) in clip_to_slabs(mesh, &cuts).into_iter().enumerate() {
        if let Some(lid) = lids.get(slab) {
            part.append(lid);
        }
        if bottoms {
            let mut bottom = match slab {
                0 => mesh
                    .bounds()
                    .map_or_else(TriangleMesh::default, |b| closing_lid(mesh, b.0[2])),
                _ => lids[slab - 1].clone(),
            };
            bottom.flip();
            part.append(&bottom);
        }
        part = part.welded(1e-6);
        let Some(frame) = OrientedBox::around(&part) else {
            continue;
        };
        // That of an open mesh may come out below 0.
        let volume = part.volume_above(frame.base[2]).max(0.0);
        let mesh = in_unit_box(&part, &frame);
        let heights = height_map(&mesh, CELLS, SAMPLES);
        let turned = upside_down(&heights);
        let mut component = Component {
            building,
            slab,
            frame,
            mesh,
            heights,
            volume,
            symmetric: turned.is_none(),
            stated: None,
            windows: None,
            looks: Vec::new(),
            texture_bytes: 0.0,
            texture: None,
        };
        if turned == Some(true) {
            half_turn(&mut component);
        }
        components.push(component);
    }
    orient(&mut components);
    components
}

/// The heights at which a building is cut, increasing.
///
/// With `S_i = A(z_i) - A(z_{i+1})`, a cut is where `|S_i - S_{i-1}|` exceeds 5 % of the largest area.
pub(crate) fn cut_planes(mesh: &TriangleMesh) -> Vec<f64> {
    let Some(profile) = SectionProfile::new(mesh, STEP, MOST_SAMPLES) else {
        return Vec::new();
    };
    let stride = if profile.top - profile.base < LOW {
        FINE
    } else {
        COARSE
    };
    let area = |i: usize| profile.areas.get(i).copied().unwrap_or(0.0);
    let steps = profile.areas.len().div_ceil(stride);
    let fall = |i: usize| area(i * stride) - area((i + 1) * stride);
    let largest = profile.areas.iter().copied().fold(0.0, f64::max);
    let hit = |i: &usize| (fall(*i) - fall(*i - 1)).abs() > THRESHOLD * largest;
    let hits: Vec<usize> = (1..steps).filter(hit).collect();
    let mut cuts: Vec<f64> = Vec::new();
    for run in hits.chunk_by(|a, b| a + 1 == *b) {
        // The change lies in the steps that the differences of the run compare.
        let (first, last) = ((run[0] - 1) * stride, (run[run.len() - 1] + 1) * stride);
        let change = |j: usize| (area(j) - area(j + 1)).abs();
        let largest = (first..last).fold(first, |a, b| if change(b) > change(a) { b } else { a });
        let z = exact_height(&profile, largest);
        let clear = z - cuts.last().copied().unwrap_or(profile.base) >= LEAST_HEIGHT;
        if clear && profile.top - z >= LEAST_HEIGHT {
            cuts.push(z);
        }
    }
    cuts
}

/// The height of the largest horizontal face between samples `i` and `i + 1`, or the middle.
fn exact_height(profile: &SectionProfile, i: usize) -> f64 {
    let low = profile.base + i as f64 * profile.step;
    let high = low + profile.step;
    let faces = &profile.faces;
    let first = faces.partition_point(|f| f.0 < low - 1e-3);
    let last = faces.partition_point(|f| f.0 <= high + 1e-3);
    let mut best = (0.0, (low + high) / 2.0);
    for level in faces[first..last].chunk_by(|a, b| b.0 - a.0 < 1e-3) {
        let area = level.iter().map(|f| f.1).sum::<f64>().abs();
        if area > best.0 {
            best = (area, level[0].0);
        }
    }
    best.1
}

fn in_unit_box(mesh: &TriangleMesh, frame: &OrientedBox) -> TriangleMesh {
    TriangleMesh {
        positions: mesh.positions.iter().map(|&p| frame.to_unit(p)).collect(),
        triangles: mesh.triangles.clone(),
    }
}
