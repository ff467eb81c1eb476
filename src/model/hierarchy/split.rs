//! One more value for a hidden variable: the state that is best cut in two.

use super::super::conjugate::Linear;
use super::super::error::ModelError;
use super::fit::{Problem, Scored};
use super::infer::Scratch;
use super::params::Params;
use super::structure::Selector;
use super::wide::explained;

/// A row's share in the group under study.
struct Member {
    /// u = (1, parents, own columns).
    u: Vec<f64>,
    /// P(h, not the background | row), times the probability of the row's completion.
    states: Vec<f64>,
    /// P(s | row).
    style: Vec<f64>,
}

/// Parameters of a start for `grown` (group `g` with one state more than in `scored`): the state
/// whose cut in two by 2-means, in its own whitened residuals, gains most evidence is replaced by
/// its halves. `None` once `goes_on`, which is asked state by state, says no.
pub(crate) fn start(
    problem: &Problem,
    scored: &Scored,
    g: usize,
    goes_on: &dyn Fn() -> bool,
) -> Result<Option<Params>, ModelError> {
    let shape = &scored.shape;
    let styles = shape.structure.styles;
    let k = shape.states(g);
    let members = members(problem, scored, g)?;
    let mut best: Option<(f64, usize, Vec<bool>)> = None;
    for h in 0..k {
        if !goes_on() {
            return Ok(None);
        }
        let linear = &scored.params.linear[g][h];
        let side = cut(linear, &members, h);
        let half = |which: bool| halves(&members, shape.columns[g].len(), &side, h, which);
        let prior = &problem.priors.linear;
        let evidence = |m: &[f64]| prior.evidence(m, shape.p[g], shape.d[g]);
        let (Some(a), Some(b), Some(both)) = (
            evidence(&half(false)),
            evidence(&half(true)),
            evidence(&scored.stats.scatter[g][h]),
        ) else {
            continue;
        };
        let gain = a + b - both;
        if best.as_ref().is_none_or(|(most, ..)| gain > *most) {
            best = Some((gain, h, side));
        }
    }
    let Some((_, h, side)) = best else {
        return Err(ModelError::Singular {
            variable: problem.schema.groups[g].clone(),
        });
    };
    let mut stats = scored.stats.clone();
    let moved = halves(&members, shape.columns[g].len(), &side, h, true);
    for (m, v) in stats.scatter[g][h].iter_mut().zip(&moved) {
        *m -= v;
    }
    stats.scatter[g].push(moved);
    let mut counts = vec![0.0; styles];
    for (member, _) in members.iter().zip(&side).filter(|(_, s)| **s) {
        for (n, r) in counts.iter_mut().zip(&member.style) {
            *n += r * member.states[h];
        }
    }
    for (s, n) in counts.iter().enumerate() {
        let kept = &mut stats.tables[g][h * styles + s];
        *kept = (*kept - n).max(0.0);
    }
    stats.tables[g].extend(counts);
    let mut grown = shape.clone();
    grown.structure.selectors[g] = Selector::Hidden(k + 1);
    grown.maximize(&stats, problem.priors).map(Some)
}

/// Rows in which the group is fully observed.
fn members(problem: &Problem, scored: &Scored, g: usize) -> Result<Vec<Member>, ModelError> {
    let mut scratch = Scratch::new(&scored.shape);
    let mut members = Vec::with_capacity(problem.rows.rows);
    for row in 0..problem.rows.rows {
        problem.visit(
            &scored.params,
            row,
            &mut scratch,
            |scratch, real, _, weight| {
                if scratch.pattern.plain.contains(&g) {
                    let found = explained(scratch, scored)
                        .into_iter()
                        .find(|(i, _)| *i == g);
                    let own = scored.shape.columns[g].iter().map(|&c| real[c]);
                    members.extend(found.map(|(_, states)| Member {
                        u: std::iter::once(1.0).chain(own).collect(),
                        states: states.iter().map(|r| r * weight).collect(),
                        style: scratch.style.clone(),
                    }));
                }
            },
        )?;
    }
    Ok(members)
}

/// Weighted 2-means of the whitened residuals under state `h`, from a cut across the main axis.
fn cut(linear: &Linear, members: &[Member], h: usize) -> Vec<bool> {
    let (d, p) = (linear.d, linear.p);
    let mut z = vec![0.0; members.len() * d];
    let mut residual = vec![0.0; d];
    for (member, z) in members.iter().zip(z.chunks_mut(d)) {
        let u = &member.u;
        linear.mean(u, &mut residual);
        for (i, z) in z.iter_mut().enumerate() {
            let w = &linear.whitening[i * d..i * d + i + 1];
            *z = (0..=i).map(|j| w[j] * (u[p + j] - residual[j])).sum();
        }
    }
    let weight = |i: usize| members[i].states[h];
    let z = |i: usize| &z[i * d..(i + 1) * d];
    // Power iteration for the main axis of the second moments.
    let mut axis = vec![1.0; d];
    for _ in 0..12 {
        let mut next = vec![0.0; d];
        for i in 0..members.len() {
            let dot: f64 = z(i).iter().zip(&axis).map(|(a, b)| a * b).sum();
            for (n, v) in next.iter_mut().zip(z(i)) {
                *n += weight(i) * dot * v;
            }
        }
        let norm = next.iter().map(|v| v * v).sum::<f64>().sqrt();
        if norm < f64::MIN_POSITIVE {
            break;
        }
        axis = next.into_iter().map(|v| v / norm).collect();
    }
    let mut side: Vec<bool> = (0..members.len())
        .map(|i| z(i).iter().zip(&axis).map(|(a, b)| a * b).sum::<f64>() > 0.0)
        .collect();
    for _ in 0..8 {
        let mut centres = [vec![0.0; d], vec![0.0; d]];
        let mut total = [0.0; 2];
        for (i, &s) in side.iter().enumerate() {
            total[usize::from(s)] += weight(i);
            for (c, v) in centres[usize::from(s)].iter_mut().zip(z(i)) {
                *c += weight(i) * v;
            }
        }
        for (c, n) in centres.iter_mut().zip(total) {
            c.iter_mut().for_each(|v| *v /= n.max(1e-300));
        }
        let distance =
            |i: usize, c: &[f64]| -> f64 { z(i).iter().zip(c).map(|(a, b)| (a - b).powi(2)).sum() };
        side = (0..members.len())
            .map(|i| distance(i, &centres[1]) < distance(i, &centres[0]))
            .collect();
    }
    side
}

/// Scatter matrix of the members on one side, weighted by state `h`.
fn halves(members: &[Member], columns: usize, side: &[bool], h: usize, which: bool) -> Vec<f64> {
    let q = columns + 1;
    let mut scatter = vec![0.0; q * q];
    for (member, _) in members.iter().zip(side).filter(|(_, s)| **s == which) {
        let u = &member.u;
        for i in 0..q {
            for j in 0..=i {
                scatter[i * q + j] += member.states[h] * u[i] * u[j];
            }
        }
    }
    scatter
}
