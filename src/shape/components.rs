//! Connected areas of equal label, within a part of a label grid.

use super::LabelGrid;
use super::Span;

/// An area of equal label: cells connected through their sides.
#[derive(Debug, Clone, Copy)]
pub struct Component {
    /// Label index.
    pub label: u16,
    /// Smallest span around it.
    pub bounds: Span,
    /// Number of its cells.
    pub cells: usize,
}

impl Component {
    /// True if it fills the span around it.
    pub fn is_rectangle(&self) -> bool {
        let b = self.bounds;
        self.cells == (b.right - b.left) * (b.top - b.bottom)
    }
}

/// Numbers the connected areas of the cells within `scope`: writes each cell's area into `of_cell`
/// (indexed as the grid's cells; others are left alone) and returns the areas, in the order of their
/// first cell from the lower left. O(cells of the scope).
pub fn components(grid: &LabelGrid, scope: Span, of_cell: &mut [u32]) -> Vec<Component> {
    const NONE: u32 = u32::MAX;
    let columns = grid.columns();
    for j in scope.bottom..scope.top {
        of_cell[j * columns + scope.left..j * columns + scope.right].fill(NONE);
    }
    let mut found = Vec::new();
    let mut stack = Vec::new();
    for j in scope.bottom..scope.top {
        for i in scope.left..scope.right {
            if of_cell[j * columns + i] != NONE {
                continue;
            }
            let number = found.len() as u32;
            let label = grid.cells[j * columns + i];
            let mut component = Component {
                label,
                bounds: Span {
                    left: i,
                    right: i + 1,
                    bottom: j,
                    top: j + 1,
                },
                cells: 0,
            };
            of_cell[j * columns + i] = number;
            stack.push((i, j));
            while let Some((i, j)) = stack.pop() {
                component.cells += 1;
                let b = &mut component.bounds;
                b.left = b.left.min(i);
                b.right = b.right.max(i + 1);
                b.bottom = b.bottom.min(j);
                b.top = b.top.max(j + 1);
                let mut visit = |i: usize, j: usize| {
                    let cell = j * columns + i;
                    if of_cell[cell] == NONE && grid.cells[cell] == label {
                        of_cell[cell] = number;
                        stack.push((i, j));
                    }
                };
                if i > scope.left {
                    visit(i - 1, j);
                }
                if i + 1 < scope.right {
                    visit(i + 1, j);
                }
                if j > scope.bottom {
                    visit(i, j - 1);
                }
                if j + 1 < scope.top {
                    visit(i, j + 1);
                }
            }
            found.push(component);
        }
    }
    found
}
