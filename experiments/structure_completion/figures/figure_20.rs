//! Fig. 1, 20 and 21: a facade whose lower part is hidden is completed and put on a box, as a glTF scene.

use super::super::{folds, row};
use super::{facades, first, split};
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_io::gltf;
use edifice_io::scene_png::picture_png;
use edifice_report::{Align, Table};
use edifice_scene::relief::{material, relief};
use edifice_scene::trace::{framing, trace};
use edifice_scene::{Group, Instance, Scene};
use edifice_shape::{Axis, Facade, LabelGrid, Rect, Region, decompose};
use edifice_structure_completion::layout::lines::{lines, median};
use edifice_structure_completion::layout::{Class, Element, Layout};
use edifice_structure_completion::measure::agreement;
use edifice_structure_completion::method::{Method, complete};
use edifice_structure_completion::task::Task;

/// Metres from floor to floor, by which a facade in pixels is measured.
const FLOOR: f64 = 3.2;
/// Depth of the box, and the distance between boxes, in metres.
const DEPTH: f64 = 11.0;
const APART: f32 = 5.0;

/// Three boxes: what is observed, its completion, the truth.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let items = facades(ctx)?;
    let (shown, rest) = split(&items, 1);
    let model = folds::fast_model(&rest, ctx.seed(), |_| true)?;
    let Some(item) = shown.first() else {
        ctx.skip("no facade");
        return Ok(());
    };
    let layout = &item.layout;
    let mut rng = stream(ctx.seed(), "figure 20", 0);
    let (partial, hidden) = Task::Bottom40.hide(layout, &mut rng);
    let added = first(&complete(Method::Best, &partial, &model, 1, &mut rng));
    let whole: Vec<Element> = partial.observed.iter().chain(&added).copied().collect();
    let mut scene = Scene::default();
    let mut left = 0.0;
    let scale = metres(layout);
    for (name, elements) in [
        ("observed", &partial.observed),
        ("completed", &whole),
        ("truth", &layout.elements),
    ] {
        let front = wall(layout, elements, scale)?;
        left += add_box(&mut scene, name, &front, left)? + APART;
    }
    let size = ctx.budget().choose([120, 60], [1200, 600], [1200, 600]);
    let camera = framing(&scene, [0.3, -0.25, -0.9], size[0] as f32 / size[1] as f32);
    let picture = picture_png(&trace(&scene, &camera, size[0], size[1])).map_err(Error::method)?;
    let what = "from left to right: what is observed (the lowest 40 % are hidden), its completion, the truth";
    ctx.attach("figure_20.png", &picture, what)?;
    let bytes = gltf::to_bytes(&scene).map_err(Error::method)?;
    ctx.attach("figure_20.glb", &bytes, "the same as a glTF scene")?;
    let f1 = agreement(&added, &hidden, 0.5).f1;
    let numbers = [
        ("observed", partial.observed.len() as f64),
        ("added", added.len() as f64),
        ("hidden", hidden.len() as f64),
        ("f1", f1),
        ("triangles", scene.triangles() as f64),
    ];
    let mut table = Table::new(format!("{}, lowest 40 % hidden", layout.name))
        .column("quantity", Align::Left)
        .numbers(["value"]);
    for (metric, value) in numbers {
        let name = format!("bottom40/{}", layout.name);
        ctx.observe(row(item.dataset, "best", name, None, metric, value));
        table.row([
            metric.to_string(),
            format!("{value:.3}").trim_end_matches(".000").to_string(),
        ]);
    }
    ctx.table(&table);
    ctx.note("Boxes with the completed facade on two sides; windows and doors lie behind the wall, balconies before it. The paper's 3D models of windows and doors and its wall textures, made by hand, have no counterpart.");
    Ok(())
}

/// Metres in a unit of the layout: rows of windows are one floor apart.
fn metres(layout: &Layout) -> f64 {
    let windows: Vec<Rect> = layout.of(Class::Window).map(|e| e.rect).collect();
    let rows = lines(&windows, Axis::Y).0;
    let gap = median(rows.windows(2).map(|w| w[1].at - w[0].at));
    FLOOR / gap.unwrap_or(layout.height / 4.0)
}

/// The elements on a wall, in metres, as a tiling; balconies over what is behind them.
fn wall(layout: &Layout, elements: &[Element], scale: f64) -> Result<Facade> {
    let mut elements = elements.to_vec();
    elements.sort_by_key(|e| e.class == Class::Balcony);
    let regions = elements.iter().map(|e| {
        let r = e.rect;
        let [x, y, width, height] = [r.x, r.y, r.width, r.height].map(|v| v * scale);
        Region {
            label: e.class.name().to_string(),
            rect: Rect::new(x, y, width, height),
        }
    });
    let (width, height) = (layout.width * scale, layout.height * scale);
    let facade = Facade::new(layout.name.clone(), "m", width, height, regions.collect());
    let grid = LabelGrid::from_facade(&facade.map_err(Error::method)?, Some("wall"));
    let tiling = decompose(&grid.map_err(Error::method)?).map_err(Error::method)?;
    Ok(tiling.facade)
}

/// Adds a box whose front and back are the facade and whose sides and roof are plain; its width.
fn add_box(scene: &mut Scene, name: &str, front: &Facade, left: f32) -> Result<f32> {
    let plain = |name: &str, label: &str, width: f64, height: f64| {
        let region = Region {
            label: label.to_string(),
            rect: Rect::new(0.0, 0.0, width, height),
        };
        Facade::new(name, "m", width, height, vec![region]).map_err(Error::method)
    };
    let side = plain("side", "wall", DEPTH, front.height)?;
    let mut meshes = Vec::new();
    for facade in [front, &side] {
        for region in &facade.regions {
            let wanted = material(&region.label, 0);
            if !scene.materials.contains(&wanted) {
                scene.materials.push(wanted);
            }
        }
        let materials = &scene.materials;
        let number = |label: &str| {
            let wanted = material(label, 0);
            materials.iter().position(|m| *m == wanted).unwrap_or(0)
        };
        let mesh = relief(format!("{name} {}", facade.name), facade, number);
        scene.meshes.push(mesh);
        meshes.push(scene.meshes.len() - 1);
    }
    meshes.push(add_roof(scene, name, front));
    let (w, h, d) = (front.width as f32, front.height as f32, DEPTH as f32);
    let quarter = std::f32::consts::FRAC_PI_2;
    let turned = |mesh: usize, turns: f32, x: f32, z: f32| Instance {
        yaw: turns * quarter,
        ..Instance::at(mesh, [x, 0.0, z])
    };
    scene.groups.push(Group {
        name: name.to_string(),
        yaw: 0.0,
        translation: [left, 0.0, 0.0],
        instances: vec![
            turned(meshes[0], 0.0, 0.0, d),
            turned(meshes[1], 1.0, w, d),
            turned(meshes[0], 2.0, w, 0.0),
            turned(meshes[1], 3.0, 0.0, 0.0),
            Instance::at(meshes[2], [0.0, h, 0.0]),
        ],
    });
    Ok(w)
}

/// A flat roof that reaches a little over the walls.
fn add_roof(scene: &mut Scene, name: &str, front: &Facade) -> usize {
    let wanted = material("roof", 0);
    if !scene.materials.contains(&wanted) {
        scene.materials.push(wanted.clone());
    }
    let number = scene
        .materials
        .iter()
        .position(|m| *m == wanted)
        .unwrap_or(0);
    let (over, thick) = (0.3, 0.35);
    let (low, high) = (
        [-over, 0.0, -over],
        [front.width as f32 + over, thick, DEPTH as f32 + over],
    );
    let corner = |i: usize| {
        let pick = |axis: usize, bit: usize| {
            if i >> bit & 1 == 1 {
                high[axis]
            } else {
                low[axis]
            }
        };
        [pick(0, 0), pick(1, 1), pick(2, 2)]
    };
    // Corner i has bit 0 for x, 1 for y, 2 for z; each side counterclockwise seen from outside.
    let sides: [[u32; 4]; 6] = [
        [4, 5, 7, 6],
        [1, 0, 2, 3],
        [5, 1, 3, 7],
        [0, 4, 6, 2],
        [2, 6, 7, 3],
        [0, 1, 5, 4],
    ];
    let triangles = sides
        .iter()
        .flat_map(|s| [s[0], s[1], s[2], s[0], s[2], s[3]]);
    scene.meshes.push(edifice_scene::Mesh {
        name: format!("{name} roof"),
        positions: (0..8).map(corner).collect(),
        parts: vec![(number, triangles.collect())],
    });
    scene.meshes.len() - 1
}
