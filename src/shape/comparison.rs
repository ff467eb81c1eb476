//! A layout beside the true one: agreement of elements, areas, counts, regularity and probabilities, without knowledge of any method.
//!
//! Elements of one label are paired one to one by falling intersection over union (IoU); of equal ones the pair of the lowest indices
//! comes first. At a threshold t only pairs of at least t count, and `F1 = 2 pairs / (predicted + true)`, 1 where there is neither. The
//! thresholds are 0.5, 0.55, ..., 0.95, as for detections in COCO (Lin et al. 2014); the mean over them tells placement to the
//! pixel from a hit.

use std::collections::BTreeMap;

use super::{AnnotatedFacade, Rect, Region};

/// Thresholds of IoU: 0.5, 0.55, ..., 0.95.
pub const THRESHOLDS: [f64; 10] = [0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95];

/// Bins of probability of [`Calibration::error`].
const BINS: usize = 10;

/// Two coordinates this near, as a share of the longer side of the outline, are aligned.
const ALIGNED: f64 = 0.002;

/// Agreement of the elements of one label, or of all.
#[derive(Debug, Clone, PartialEq)]
pub struct Agreement {
    /// Number of true elements.
    pub truth: usize,
    /// Number of predicted elements.
    pub predicted: usize,
    /// Pairs at each of [`THRESHOLDS`].
    pub pairs: [usize; 10],
    /// Area that true and predicted elements share, over the area that either covers, each place counted once; 1 where neither
    /// covers any. Over all labels: sums of both areas over the labels.
    pub iou: f64,
}

impl Agreement {
    /// F1 at each of [`THRESHOLDS`], 0 to 1.
    pub fn f1(&self) -> [f64; 10] {
        let both = self.truth + self.predicted;
        self.pairs.map(|pairs| match both {
            0 => 1.0,
            both => 2.0 * pairs as f64 / both as f64,
        })
    }

    /// Mean of [`Agreement::f1`] over the thresholds.
    pub fn mean_f1(&self) -> f64 {
        self.f1().iter().sum::<f64>() / THRESHOLDS.len() as f64
    }
}

/// The regularity of a layout.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Regularity {
    /// Area in which elements of one label overlap each other, summed over pairs, over the sum of their areas; 0 without elements.
    pub overlap: f64,
    /// Distinct edge coordinates over all edges (four an element), where those of one axis within 0.2 % of the longer side, each from the
    /// next, are one; small is regular, 1 is without any alignment, 0 without elements.
    pub distinct_edges: f64,
}

/// The agreement of probabilities of predicted elements with hits at an IoU of 0.5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibration {
    /// Predicted elements that carry a probability.
    pub elements: usize,
    /// Mean squared difference of probability and hit (Brier 1950), 0 to 1.
    pub brier: f64,
    /// Mean absolute difference of mean probability and share of hits over ten equal bins of probability, weighted by their elements, 0 to 1.
    pub error: f64,
}

/// A predicted layout beside the true one.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Over all labels.
    pub all: Agreement,
    /// Of each label that occurs in either.
    pub labels: BTreeMap<String, Agreement>,
    /// Regularity of the true layout.
    pub truth: Regularity,
    /// Regularity of the predicted layout.
    pub predicted: Regularity,
    /// `None` where no predicted element carries a probability.
    pub calibration: Option<Calibration>,
}

/// Two layouts of different outlines.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the outline is {found:?}, that of the truth {truth:?}")]
pub struct OutlineError {
    /// Width and height of the predicted layout.
    pub found: [f64; 2],
    /// Width and height of the true one.
    pub truth: [f64; 2],
}

/// As [`compare`], of two layouts of one facade. Where the predicted one names an unknown part, only elements whose centre lies in it
/// count, unless the `whole` layout is asked for.
///
/// # Errors
/// [`OutlineError`] for outlines that differ by more than 1e-6 of the longer side.
pub fn compare_layouts(
    truth: &AnnotatedFacade,
    predicted: &AnnotatedFacade,
    whole: bool,
) -> Result<Comparison, OutlineError> {
    let size = |layout: &AnnotatedFacade| [layout.facade.width, layout.facade.height];
    let (wanted, found) = (size(truth), size(predicted));
    let longer = wanted[0].max(wanted[1]);
    if (0..2).any(|k| (wanted[k] - found[k]).abs() > 1e-6 * longer) {
        let truth = wanted;
        return Err(OutlineError { found, truth });
    }
    let counts = |rect: &Rect| match &predicted.unknown {
        Some(unknown) if !whole => {
            let (x, y) = rect.centre();
            unknown.iter().any(|u| u.contains(x, y))
        }
        _ => true,
    };
    let truth: Vec<Region> = (truth.facade.regions.iter())
        .filter(|region| counts(&region.rect))
        .cloned()
        .collect();
    let (mut regions, mut probabilities) = (Vec::new(), Vec::new());
    for (region, note) in predicted.facade.regions.iter().zip(&predicted.notes) {
        if counts(&region.rect) {
            regions.push(region.clone());
            probabilities.push(note.probability);
        }
    }
    Ok(compare(&truth, &regions, &probabilities, longer))
}

/// Compares predicted regions with true ones. `probabilities` are those of the predicted regions, in their order; regions beyond its end have
/// none. `longer` is the longer side of the outline, in the unit of the regions.
///
/// Time: O(n m log(n m)) for n true and m predicted regions of a label.
///
/// # Examples
/// ```
/// use edifice_shape::{Rect, Region, comparison::compare};
/// let window = |x| Region { label: "window".into(), rect: Rect::new(x, 0.0, 2.0, 2.0) };
/// let found = compare(&[window(0.0), window(10.0)], &[window(0.5)], &[], 20.0);
/// // One of two is found, at an IoU of 3/5.
/// assert_eq!(found.all.pairs[..4], [1, 1, 1, 0]);
/// assert!((found.all.f1()[0] - 2.0 / 3.0).abs() < 1e-12);
/// ```
pub fn compare(
    truth: &[Region],
    predicted: &[Region],
    probabilities: &[Option<f64>],
    longer: f64,
) -> Comparison {
    let mut names: Vec<&str> = truth
        .iter()
        .chain(predicted)
        .map(|r| r.label.as_str())
        .collect();
    names.sort_unstable();
    names.dedup();
    let mut labels = BTreeMap::new();
    let mut hits = vec![false; predicted.len()];
    let (mut shared, mut union, mut pairs) = (0.0, 0.0, [0; 10]);
    for name in names {
        let of = |regions: &[Region]| -> Vec<(usize, Rect)> {
            let all = regions.iter().enumerate();
            let own = all.filter(|(_, r)| r.label == name);
            own.map(|(index, r)| (index, r.rect)).collect()
        };
        let (t, p) = (of(truth), of(predicted));
        let candidates = candidates(&t, &p);
        let mut found = [0; 10];
        for (slot, least) in found.iter_mut().zip(THRESHOLDS) {
            let matched = matched(&candidates, t.len(), p.len(), least);
            *slot = matched.len();
            if least == THRESHOLDS[0] {
                matched.iter().for_each(|&at| hits[p[at].0] = true);
            }
        }
        let rects = |side: &[(usize, Rect)]| side.iter().map(|(_, r)| *r).collect::<Vec<_>>();
        let (a, b) = (rects(&t), rects(&p));
        let either = covered(&[a.as_slice(), b.as_slice()].concat());
        let both = covered(&a) + covered(&b) - either;
        shared += both;
        union += either;
        (0..10).for_each(|k| pairs[k] += found[k]);
        let agreement = Agreement {
            truth: t.len(),
            predicted: p.len(),
            pairs: found,
            iou: ratio(both, either),
        };
        labels.insert(name.to_owned(), agreement);
    }
    Comparison {
        all: Agreement {
            truth: truth.len(),
            predicted: predicted.len(),
            pairs,
            iou: ratio(shared, union),
        },
        labels,
        truth: regularity(truth, longer),
        predicted: regularity(predicted, longer),
        calibration: calibration(&hits, probabilities),
    }
}

fn ratio(shared: f64, union: f64) -> f64 {
    if union > 0.0 { shared / union } else { 1.0 }
}

/// Pairs of true and predicted rectangles that overlap, by falling IoU: IoU, index of the true one, index of the predicted one.
fn candidates(truth: &[(usize, Rect)], predicted: &[(usize, Rect)]) -> Vec<(f64, usize, usize)> {
    let mut pairs = Vec::new();
    for (i, (_, t)) in truth.iter().enumerate() {
        for (j, (_, p)) in predicted.iter().enumerate() {
            let iou = t.iou(p);
            if iou >= THRESHOLDS[0] {
                pairs.push((iou, i, j));
            }
        }
    }
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    pairs
}

/// The predicted ones that are paired one to one at a threshold.
fn matched(
    candidates: &[(f64, usize, usize)],
    truth: usize,
    predicted: usize,
    least: f64,
) -> Vec<usize> {
    let mut taken = (vec![false; truth], vec![false; predicted]);
    let mut matched = Vec::new();
    for &(_, i, j) in candidates.iter().take_while(|pair| pair.0 >= least) {
        if !taken.0[i] && !taken.1[j] {
            (taken.0[i], taken.1[j]) = (true, true);
            matched.push(j);
        }
    }
    matched
}

/// Area of a union of rectangles, strip by strip; in the square of their unit.
pub fn covered(rects: &[Rect]) -> f64 {
    let mut xs: Vec<f64> = rects.iter().flat_map(|r| [r.x, r.right()]).collect();
    xs.sort_by(f64::total_cmp);
    xs.dedup();
    let mut area = 0.0;
    for strip in xs.windows(2) {
        let across = rects
            .iter()
            .filter(|r| r.x <= strip[0] && r.right() >= strip[1]);
        let mut spans: Vec<(f64, f64)> = across.map(|r| (r.y, r.top())).collect();
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut length, mut reached) = (0.0, f64::NEG_INFINITY);
        for (from, to) in spans {
            length += (to - from.max(reached)).max(0.0);
            reached = reached.max(to);
        }
        area += length * (strip[1] - strip[0]);
    }
    area
}

fn regularity(regions: &[Region], longer: f64) -> Regularity {
    let (mut overlap, mut area) = (0.0, 0.0);
    for (index, region) in regions.iter().enumerate() {
        area += region.rect.area();
        let others = regions[..index].iter().filter(|r| r.label == region.label);
        overlap += others.map(|r| r.rect.overlap(&region.rect)).sum::<f64>();
    }
    let distinct = |mut edges: Vec<f64>| {
        edges.sort_by(f64::total_cmp);
        let apart = |pair: &&[f64]| pair[1] - pair[0] > ALIGNED * longer;
        usize::from(!edges.is_empty()) + edges.windows(2).filter(apart).count()
    };
    let vertical = distinct(
        regions
            .iter()
            .flat_map(|r| [r.rect.x, r.rect.right()])
            .collect(),
    );
    let horizontal = distinct(
        regions
            .iter()
            .flat_map(|r| [r.rect.y, r.rect.top()])
            .collect(),
    );
    let edges = 4.0 * regions.len().max(1) as f64;
    Regularity {
        overlap: if area > 0.0 { overlap / area } else { 0.0 },
        distinct_edges: (vertical + horizontal) as f64 / edges,
    }
}

fn calibration(hits: &[bool], probabilities: &[Option<f64>]) -> Option<Calibration> {
    let told: Vec<(f64, f64)> = (hits.iter().zip(probabilities))
        .filter_map(|(&hit, p)| Some(((*p)?, f64::from(u8::from(hit)))))
        .collect();
    if told.is_empty() {
        return None;
    }
    let n = told.len() as f64;
    let mut bins = [(0.0, 0.0); BINS];
    for &(p, hit) in &told {
        let bin = &mut bins[((p * BINS as f64) as usize).min(BINS - 1)];
        bin.0 += p;
        bin.1 += hit;
    }
    Some(Calibration {
        elements: told.len(),
        brier: told.iter().map(|(p, hit)| (p - hit).powi(2)).sum::<f64>() / n,
        error: bins.iter().map(|(p, hit)| (p - hit).abs()).sum::<f64>() / n,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn region(label: &str, x: f64, y: f64) -> Region {
        Region {
            label: label.into(),
            rect: Rect::new(x, y, 2.0, 2.0),
        }
    }

    #[test]
    fn a_layout_agrees_with_itself() {
        let layout = [region("window", 0.0, 0.0), region("door", 5.0, 0.0)];
        let found = compare(&layout, &layout, &[Some(1.0), Some(1.0)], 10.0);
        assert_eq!(found.all.pairs, [2; 10]);
        assert_eq!((found.all.mean_f1(), found.all.iou), (1.0, 1.0));
        assert_eq!(found.calibration.unwrap().brier, 0.0);
        assert_eq!(found.predicted.overlap, 0.0);
        // x: 0, 2, 5, 7; y: 0, 2.
        assert_eq!(found.predicted.distinct_edges, 6.0 / 8.0);
    }

    #[test]
    fn labels_are_apart_and_nothing_agrees_with_nothing() {
        let found = compare(
            &[region("window", 0.0, 0.0)],
            &[region("door", 0.0, 0.0)],
            &[],
            9.0,
        );
        assert_eq!(found.all.pairs, [0; 10]);
        assert_eq!((found.all.iou, found.labels.len()), (0.0, 2));
        let nothing = compare(&[], &[], &[], 1.0);
        assert_eq!((nothing.all.mean_f1(), nothing.all.iou), (1.0, 1.0));
        assert!(nothing.calibration.is_none());
    }

    #[test]
    fn doubles_are_one_hit_and_overlap() {
        let twice = [region("window", 0.0, 0.0), region("window", 0.0, 0.0)];
        let found = compare(&twice[..1], &twice, &[Some(0.5), Some(0.5)], 9.0);
        assert_eq!(found.all.pairs, [1; 10]);
        assert_eq!(found.predicted.overlap, 0.5);
        let calibration = found.calibration.unwrap();
        assert_eq!((calibration.brier, calibration.error), (0.25, 0.0));
    }
}
