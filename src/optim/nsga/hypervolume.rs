//! The volume that a front dominates.

/// The volume of the union of boxes from each point to `reference`, all costs minimised: larger is better.
///
/// Exact, by slices along the last cost: O(n log n) for two costs, O(n² log n) for three, and one factor of n more for each further one.
/// Points that are not below the reference in every cost count for nothing. Source: Zitzler and Thiele 1998; Fonseca, Paquete and
/// López-Ibáñez 2006 (slices).
///
/// # Examples
/// ```
/// use edifice_optim::nsga::hypervolume;
/// let points = vec![vec![1.0, 3.0], vec![2.0, 1.0], vec![3.0, 3.0]];
/// assert_eq!(hypervolume(&points, &[4.0, 4.0]), 7.0);
/// ```
pub fn hypervolume(points: &[Vec<f64>], reference: &[f64]) -> f64 {
    let below =
        |p: &&Vec<f64>| p.len() == reference.len() && p.iter().zip(reference).all(|(x, r)| x < r);
    let mut points: Vec<&[f64]> = points.iter().filter(below).map(Vec::as_slice).collect();
    volume(&mut points, reference)
}

fn volume(points: &mut Vec<&[f64]>, reference: &[f64]) -> f64 {
    let Some(last) = reference.len().checked_sub(1) else {
        return 0.0;
    };
    if last == 0 {
        let least = points.iter().map(|p| p[0]).fold(reference[0], f64::min);
        return reference[0] - least;
    }
    points.sort_by(|a, b| a[last].total_cmp(&b[last]));
    if last == 1 {
        // Steps of a staircase.
        let (mut sum, mut edge) = (0.0, reference[0]);
        for p in points.iter().filter(|p| !p[0].is_nan()) {
            if p[0] < edge {
                sum += (edge - p[0]) * (reference[1] - p[1]);
                edge = p[0];
            }
        }
        return sum;
    }
    let mut sum = 0.0;
    for i in 0..points.len() {
        let top = points.get(i + 1).map_or(reference[last], |p| p[last]);
        let height = top - points[i][last];
        if height > 0.0 {
            let mut below: Vec<&[f64]> = points[..=i].iter().map(|p| &p[..last]).collect();
            sum += height * volume(&mut below, &reference[..last]);
        }
    }
    sum
}
