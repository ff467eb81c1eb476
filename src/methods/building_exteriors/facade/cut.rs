//! The asymmetric strips: a subset and at most one cut that have exactly the wanted area.

/// A strip as symmetry sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Candidate {
    pub width: f64,
    /// Heights of its pieces that can hold windows off their middle, summed: area is width times this.
    pub height: f64,
    /// True if it must not be cut: a piece that stays as it is stands on it.
    pub whole: bool,
}

/// Asymmetric strips and, for one of them, how wide the asymmetric part is.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Choice {
    pub asymmetric: Vec<bool>,
    pub cut: Option<(usize, f64)>,
    /// Area missed.
    pub error: f64,
}

/// Narrowest asymmetric part, and narrowest rest.
pub(super) const NARROWEST: f64 = 1.35;
const REST: f64 = 0.3;
/// Largest strips that take part.
const MOST: usize = 10;

/// All choices whose error is at most `enough`, else the best ones; in order of number of asymmetric strips and cut
/// width from the middle, at most `count`.
pub(super) fn choices(
    strips: &[Candidate],
    wanted: f64,
    enough: f64,
    allow_cuts: bool,
    count: usize,
) -> Vec<Choice> {
    let mut free: Vec<usize> = (0..strips.len())
        .filter(|&i| strips[i].height > 0.0 && strips[i].width >= NARROWEST)
        .collect();
    free.sort_by(|&a, &b| area(&strips[b]).total_cmp(&area(&strips[a])));
    free.truncate(MOST);
    let mut found: Vec<Choice> = Vec::new();
    for mask in 0..1_u32 << free.len() {
        let chosen = |k: usize| mask >> k & 1 == 1;
        let sum: f64 = (0..free.len())
            .filter(|&k| chosen(k))
            .map(|k| area(&strips[free[k]]))
            .sum();
        let mut asymmetric = vec![false; strips.len()];
        for k in (0..free.len()).filter(|&k| chosen(k)) {
            asymmetric[free[k]] = true;
        }
        found.push(Choice {
            asymmetric: asymmetric.clone(),
            cut: None,
            error: (wanted - sum).abs(),
        });
        if !allow_cuts || sum >= wanted {
            continue;
        }
        for k in (0..free.len()).filter(|&k| !chosen(k)) {
            let strip = &strips[free[k]];
            if strip.whole {
                continue;
            }
            let most = strip.width - REST;
            if most < NARROWEST {
                continue;
            }
            let width = ((wanted - sum) / strip.height).clamp(NARROWEST, most);
            let width = (width * 1000.0).round() / 1000.0;
            let mut asymmetric = asymmetric.clone();
            asymmetric[free[k]] = true;
            found.push(Choice {
                asymmetric,
                cut: Some((free[k], width)),
                error: (wanted - sum - width * strip.height).abs(),
            });
        }
    }
    // Without a cut first, then by how few strips are disturbed.
    let rank = |c: &Choice| {
        let error = if c.error <= enough { 0.0 } else { c.error };
        let strips = c.asymmetric.iter().filter(|a| **a).count();
        (error, u8::from(c.cut.is_some()), strips)
    };
    found.sort_by(|a, b| {
        let (p, q) = (rank(a), rank(b));
        p.0.total_cmp(&q.0).then((p.1, p.2).cmp(&(q.1, q.2)))
    });
    found.truncate(count);
    found
}

fn area(strip: &Candidate) -> f64 {
    strip.width * strip.height
}
