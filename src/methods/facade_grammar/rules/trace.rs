//! Shortest paths along lines, told by their predecessors.

/// Follows predecessors back from `end` to 0.
pub(super) fn trace(previous: &[u16], end: usize) -> Vec<u16> {
    let mut lines = vec![end as u16];
    let mut at = end;
    while at > 0 {
        at = usize::from(previous[at]);
        lines.push(at as u16);
    }
    lines.reverse();
    lines
}
