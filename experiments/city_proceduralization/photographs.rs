//! Photographs of facades that stand next to each other, and how often they are found.

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use edifice_base::rng::{Stream, stream};
use edifice_city_proceduralization::facades::{Facade, facades, photographed};
use edifice_city_proceduralization::localization::{Landmark, landmarks, locate_facades};
use edifice_shape::triangles::{City, OrientedBox, SideView, view_size};

/// Least side of a pixel of a photograph, in metres.
const PIXEL: f64 = 0.1;
/// Most pixels along a side.
const MOST: f64 = 256.0;
/// Share of a facade that has to be painted to be photographed.
const PAINTED: f64 = 0.9;

/// The buildings of a city whose facades can be photographed.
pub(crate) struct Streets<'a> {
    city: &'a City,
    landmarks: Vec<Landmark>,
    /// Index in the city of each landmark.
    buildings: Vec<usize>,
    /// Facades of each landmark.
    pub facades: Vec<Vec<Facade>>,
}

impl<'a> Streets<'a> {
    pub(crate) fn new(city: &'a City) -> Self {
        let (all, indices) = landmarks(city);
        let (mut own, mut buildings, mut known) = (Vec::new(), Vec::new(), Vec::new());
        for (landmark, index) in all.into_iter().zip(indices) {
            let found = facades(&city.buildings[index]);
            if !found.is_empty() {
                own.push(landmark);
                buildings.push(index);
                known.push(found);
            }
        }
        Self {
            city,
            landmarks: own,
            buildings,
            facades: known,
        }
    }

    /// The facades of the same buildings in another city, by their identifiers.
    pub(crate) fn of(&self, other: &City) -> Vec<Vec<Facade>> {
        let by_id: std::collections::BTreeMap<&str, usize> = (other.buildings.iter())
            .enumerate()
            .map(|(i, b)| (b.id.as_str(), i))
            .collect();
        let facades_of = |b: &usize| {
            let index = by_id.get(self.city.buildings[*b].id.as_str());
            index.map_or_else(Vec::new, |&i| facades(&other.buildings[i]))
        };
        self.buildings.iter().map(facades_of).collect()
    }

    /// Share of `views` views, each of the `count` buildings nearest to a random one, of which the first place found is one of
    /// them. A photograph is of one of a building's facades, with `noise` in greys.
    pub(crate) fn rank_one(
        &self,
        known: &[Vec<Facade>],
        count: usize,
        noise: f64,
        views: usize,
        seed: u64,
    ) -> f64 {
        let mut rng = stream(seed, "photographs", count as u64);
        let (mut taken, mut right) = (0, 0);
        for _ in 0..20 * views {
            if taken == views {
                break;
            }
            let near = self.nearest(rng.random_range(0..self.landmarks.len()), count);
            let view: Option<Vec<Facade>> = (near.iter())
                .map(|&l| self.photograph(l, noise, &mut rng))
                .collect();
            // One without a facade that is painted all over is not photographed.
            let Some(view) = view else { continue };
            taken += 1;
            let found = locate_facades(&self.landmarks, known, &view, 1);
            right += usize::from(found.first().is_some_and(|f| near.contains(&f.landmark)));
        }
        right as f64 / f64::from(taken.max(1) as u32)
    }

    fn nearest(&self, from: usize, count: usize) -> Vec<usize> {
        let at = self.landmarks[from].at;
        let far = |&l: &usize| {
            let p = self.landmarks[l].at;
            (p[0] - at[0]).hypot(p[1] - at[1])
        };
        let mut all: Vec<usize> = (0..self.landmarks.len()).collect();
        all.sort_by(|a, b| far(a).total_cmp(&far(b)).then(a.cmp(b)));
        all.truncate(count);
        all
    }

    fn photograph(&self, landmark: usize, noise: f64, rng: &mut Stream) -> Option<Facade> {
        let building = &self.city.buildings[self.buildings[landmark]];
        let frame = OrientedBox::around(&building.mesh)?;
        let first = rng.random_range(0..4);
        let sides = (0..4).map(|k| (first + k) % 4);
        let view = |side: usize| {
            let [across, up] = view_size(&frame, side);
            let pixel = PIXEL.max(across.max(up) / MOST);
            let count = [across, up].map(|v| (v / pixel).ceil().max(1.0) as usize);
            let view = SideView::whole(&building.paint, &frame, side, count);
            (view.painted() >= PAINTED).then_some(view)
        };
        let view = sides.filter_map(view).next()?;
        let rows = view.colours.chunks(view.width).rev();
        let noisy = rows.flatten().map(|colour| {
            let z: f64 = StandardNormal.sample(rng);
            let colour = colour.unwrap_or([128; 3]);
            colour.map(|v| (f64::from(v) + noise * z).round().clamp(0.0, 255.0) as u8)
        });
        photographed(view.width, &noisy.collect::<Vec<_>>())
    }
}
