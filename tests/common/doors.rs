//! Doors of completions.

use edifice::methods::structure_completion::layout::{Class, Element};
use edifice::shape::Rect;

/// True if a window or a shop stands beside a door: their heights have more than 0.3 of the smaller one in common.
pub(crate) fn has_company(door: &Rect, all: &[Element]) -> bool {
    all.iter().any(|e| {
        let front = matches!(e.class, Class::Window | Class::Shop);
        let common = e.rect.top().min(door.top()) - e.rect.y.max(door.y);
        front && common > 0.3 * e.rect.height.min(door.height)
    })
}

/// Number of doors among some elements, and of those that stand alone beside all elements.
pub(crate) fn doors_and_alone(some: &[Element], all: &[Element]) -> [usize; 2] {
    let doors = some.iter().filter(|e| e.class == Class::Door);
    let alone = |d: &&Element| !has_company(&d.rect, all);
    [doors.clone().count(), doors.filter(alone).count()]
}
