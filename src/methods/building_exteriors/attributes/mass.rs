//! Mass model attributes `M_c` (Appendix A.1): 27 numbers.

use edifice_shape::{BoxStyle, Building, MassBox, PlanUnion, Rect, visibility};

/// `bbox`, `bcr`, `bdry`, `far`, `arf`, `garage`, `porch`, in the order of the columns.
pub(super) fn attributes(building: &Building) -> Vec<f64> {
    let ground_plan = building.floor_plan(0);
    let ground = PlanUnion::new(&ground_plan);
    // Every box stands on the ground, so the union is never empty.
    let bounds = ground
        .bounding_box()
        .unwrap_or(Rect::new(0.0, 0.0, 1.0, 1.0));
    let heights = building.boxes.iter().map(|b| b.height);
    let floors: Vec<f64> = (0..3)
        .map(|k| PlanUnion::new(&building.floor_plan(k)).area())
        .collect();
    let total: f64 = floors.iter().sum();

    let mut out = vec![
        bounds.width,
        bounds.height,
        heights.fold(0.0, f64::max),
        floors[0] / bounds.area(),
        ground.perimeter() / floors[0].sqrt(),
        total / bounds.area(),
    ];
    out.extend(floors.iter().map(|area| area / total));

    let middle = bounds.y + bounds.height / 2.0;
    let part = |belongs: &dyn Fn(&MassBox) -> bool| {
        let boxes: Vec<&MassBox> = building.boxes.iter().filter(|b| belongs(b)).collect();
        part_attributes(&boxes, &ground_plan, &bounds)
    };
    out.extend(part(&|b| b.style == BoxStyle::Garage));
    out.extend(part(&|b| b.style == BoxStyle::Porch && b.y < middle));
    out.extend(part(&|b| b.style == BoxStyle::Porch && b.y >= middle));
    out
}

/// Position, size and exposure of a garage or porch; zeros when there is none.
fn part_attributes(boxes: &[&MassBox], ground_plan: &[Rect], bounds: &Rect) -> [f64; 6] {
    let plan: Vec<Rect> = boxes.iter().map(|b| b.plan()).collect();
    let Some(own) = PlanUnion::new(&plan).bounding_box() else {
        return [0.0; 6];
    };
    let height = boxes.iter().map(|b| b.height).fold(0.0, f64::max);
    let seen = visibility(&plan, ground_plan);
    [
        (own.x + own.width / 2.0 - bounds.x) / bounds.width,
        (own.y + own.height / 2.0 - bounds.y) / bounds.height,
        own.width,
        own.height,
        height,
        seen.visible / seen.perimeter,
    ]
}
