//! The coarse level of 3D Tiles: each instance as the box that its template fills, and the distance that this is from the template.

use edifice_grammar::instance::{InstanceDerivation, InstanceGrammar, Template, TemplateInstance};
use edifice_shape::triangles::{SurfaceDistance, TriangleMesh};

/// Points along a side of a box at which distances are measured.
const POINTS: usize = 5;

/// A grammar of one template, the unit box.
pub(super) fn boxes(grammar: &InstanceGrammar) -> InstanceGrammar {
    InstanceGrammar {
        name: grammar.name.clone(),
        reference_system: grammar.reference_system.clone(),
        origin: grammar.origin,
        axiom: grammar.axiom.clone(),
        templates: vec![Template {
            symbol: "Box".into(),
            mesh: unit_box(),
            texture: None,
        }],
        rules: Vec::new(),
    }
}

/// For each instance, in metres: no point of its box is farther from it, and no corner of it from its box. Points of the box are
/// [`POINTS`] a side.
pub(super) fn box_errors(grammar: &InstanceGrammar, derivation: &InstanceDerivation) -> Vec<f64> {
    // A box that is longer along a side has no smaller distances: those of a template are measured in a box as long along each side as
    // any of its instances, and are less for one that is smaller along all sides.
    let mut largest = vec![[0.0f64; 3]; grammar.templates.len()];
    for instance in &derivation.instances {
        let own = &mut largest[instance.template];
        *own = [0, 1, 2].map(|k| own[k].max(instance.size[k].abs()));
    }
    let all = grammar.templates.iter().zip(&largest);
    let errors: Vec<f64> = all.map(|(t, size)| box_error(&t.mesh, *size)).collect();
    let error = |i: &TemplateInstance| {
        let largest = largest[i.template];
        let share = |k: usize| match largest[k] {
            0.0 => 0.0,
            most => i.size[k].abs() / most,
        };
        errors[i.template] * (0..3).map(share).fold(0.0, f64::max)
    };
    derivation.instances.iter().map(error).collect()
}

fn box_error(mesh: &TriangleMesh, size: [f64; 3]) -> f64 {
    if size == [0.0; 3] || mesh.triangles.is_empty() {
        return 0.0;
    }
    let scaled = |p: [f64; 3]| [0, 1, 2].map(|k| p[k] * size[k]);
    let template = SurfaceDistance::new(mesh.corners().map(|t| t.map(scaled)));
    let unit = unit_box();
    let whole = SurfaceDistance::new(unit.corners().map(|t| t.map(scaled)));
    let step = |i: usize| i as f64 / (POINTS - 1) as f64;
    let cells = (0..POINTS).flat_map(|i| (0..POINTS).map(move |j| [step(i), step(j)]));
    let on_the_box = cells.flat_map(|[u, v]| {
        [
            [u - 0.5, v - 0.5, 1.0],
            [u - 0.5, -0.5, v],
            [u - 0.5, 0.5, v],
            [-0.5, u - 0.5, v],
            [0.5, u - 0.5, v],
        ]
    });
    let from_the_box = on_the_box.map(|p| template.distance(scaled(p)));
    let corners = mesh.positions.iter();
    let from_the_template = corners.map(|&p| whole.distance(scaled(p)));
    from_the_box.chain(from_the_template).fold(0.0, f64::max)
}

/// The box of templates, x and y within 1/2 of 0, z from 0 to 1, without its base.
fn unit_box() -> TriangleMesh {
    let corner = |i: u32| {
        [
            f64::from(i & 1) - 0.5,
            f64::from(i >> 1 & 1) - 0.5,
            f64::from(i >> 2),
        ]
    };
    let faces: [[u32; 4]; 5] = [
        [0, 1, 5, 4],
        [1, 3, 7, 5],
        [3, 2, 6, 7],
        [2, 0, 4, 6],
        [4, 5, 7, 6],
    ];
    TriangleMesh {
        positions: (0..8).map(corner).collect(),
        triangles: faces
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::{box_error, box_errors, boxes, unit_box};
    use edifice_grammar::instance::{
        InstanceDerivation, InstanceGrammar, Template, TemplateInstance,
    };
    use edifice_shape::triangles::TriangleMesh;
    use rand::RngExt;

    #[test]
    fn a_box_is_its_own_box_and_a_roof_is_as_far_as_it_falls() {
        let size = [20.0, 10.0, 8.0];
        assert_eq!(box_error(&unit_box(), size), 0.0);
        // A plate at half the height: the upper edges of the box are 4 m above it.
        let mut plate = unit_box();
        plate.positions.iter_mut().for_each(|p| p[2] *= 0.5);
        assert!((box_error(&plate, size) - 4.0).abs() < 1e-9);
        // Twice as high, twice as far; never less where a side is longer.
        assert!((box_error(&plate, [20.0, 10.0, 16.0]) - 8.0).abs() < 1e-9);
        assert_eq!(box_error(&TriangleMesh::default(), size), 0.0);
    }

    /// The errors of instances, from those of their templates at their largest, are not below those that each instance has itself.
    #[test]
    fn no_instance_is_farther_from_its_box_than_told() {
        let mut rng = edifice_base::rng::stream(1, "boxes", 0);
        for _ in 0..200 {
            let mut at =
                || std::array::from_fn(|k| rng.random_range(0.0..1.0) - [0.5, 0.5, 0.0][k]);
            let mesh = TriangleMesh {
                positions: (0..9).map(|_| at()).collect(),
                triangles: (0..7).map(|i| [i, i + 1, i + 2]).collect(),
            };
            let grammar = InstanceGrammar {
                templates: vec![Template {
                    symbol: "T".into(),
                    mesh: mesh.clone(),
                    texture: None,
                }],
                ..boxes(&InstanceGrammar {
                    name: String::new(),
                    reference_system: None,
                    origin: [0.0; 3],
                    axiom: "City".into(),
                    templates: Vec::new(),
                    rules: Vec::new(),
                })
            };
            let mut derivation = InstanceDerivation::default();
            for i in 0..10 {
                let side = |rng: &mut edifice_base::rng::Stream| rng.random_range(0.0..50.0);
                derivation.instances.push(TemplateInstance {
                    template: 0,
                    building: None,
                    at: [0.0; 3],
                    turn: 0.0,
                    // Some are flat.
                    size: [
                        side(&mut rng),
                        side(&mut rng),
                        if i == 0 { 0.0 } else { side(&mut rng) },
                    ],
                });
            }
            let told = box_errors(&grammar, &derivation);
            for (instance, told) in derivation.instances.iter().zip(told) {
                assert!(box_error(&mesh, instance.size) <= told + 1e-9);
            }
        }
    }
}
