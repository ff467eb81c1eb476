//! Laws of the procedural logic: lossless, online, bounded, whatever the threads.

use edifice::grammar::derive;
use edifice::methods::procedural_logic::{
    Affinity, Alphabet, BinaryNode, Canvas, Extent, Facing, Inference, Model, NaryNode, NaryTree,
    Parameters, Profile, learn_affinity, parse, split_grammar,
};
use edifice::rng::stream;
use edifice::shape::{Axis, Facade, LabelGrid, Lattice};
use proptest::prelude::*;
use rand::RngExt;

const LABELS: [&str; 4] = ["wall", "window", "door", "sky"];

/// A label image from rows of digits, the top row first.
fn image(rows: &[&str]) -> LabelGrid {
    let (width, height) = (rows[0].len(), rows.len());
    let digit = |c: u8| u16::from(c - b'0');
    LabelGrid {
        name: "image".into(),
        unit: "px".into(),
        xs: (0..=width).map(|x| x as f64).collect(),
        ys: (0..=height).map(|y| y as f64).collect(),
        labels: LABELS.map(String::from).to_vec(),
        cells: rows
            .iter()
            .rev()
            .flat_map(|row| row.bytes().map(digit))
            .collect(),
    }
}

/// A facade of floors and bays, with a door, by seed.
fn regular(seed: u64) -> LabelGrid {
    let mut rng = stream(seed, "regular", 0);
    let (bays, floors) = (rng.random_range(1..5), rng.random_range(1..5));
    let (width, height) = (5 * bays + 2, 6 * floors + 4);
    let mut cells = vec![0; width * height];
    let mut fill = |x: usize, y: usize, w: usize, h: usize, label: u16| {
        for row in y..y + h {
            cells[row * width + x..row * width + x + w].fill(label);
        }
    };
    fill(0, height - 2, width, 2, 3);
    for floor in 0..floors {
        for bay in 0..bays {
            let door = floor == 0 && bay == 0;
            fill(
                2 + 5 * bay,
                6 * floor + 2 - 2 * usize::from(door),
                3,
                3,
                if door { 2 } else { 1 },
            );
        }
    }
    LabelGrid {
        name: format!("regular {seed}"),
        unit: "px".into(),
        xs: (0..=width).map(|x| x as f64).collect(),
        ys: (0..=height).map(|y| y as f64).collect(),
        labels: LABELS.map(String::from).to_vec(),
        cells,
    }
}

/// The first pixel at which a layout differs from a label image.
fn first_difference(grid: &LabelGrid, facade: &Facade) -> Option<(usize, usize)> {
    let mut painted = vec![None; grid.cells.len()];
    for region in &facade.regions {
        let label = grid.labels.iter().position(|l| *l == region.label);
        let whole = |value: f64| {
            assert!((value - value.round()).abs() < 1e-6, "{value} is no pixel");
            value.round() as usize
        };
        for y in whole(region.rect.y)..whole(region.rect.top()) {
            for x in whole(region.rect.x)..whole(region.rect.right()) {
                assert!(painted[y * grid.columns() + x].is_none(), "painted twice");
                painted[y * grid.columns() + x] = label;
            }
        }
    }
    let differs = |&cell: &usize| painted[cell] != Some(usize::from(grid.cells[cell]));
    let cell = (0..grid.cells.len()).find(differs)?;
    Some((cell % grid.columns(), cell / grid.columns()))
}

fn noise() -> impl Strategy<Value = LabelGrid> {
    (1_usize..12, 1_usize..12).prop_flat_map(|(width, height)| {
        proptest::collection::vec(0_u16..3, width * height).prop_map(move |cells| LabelGrid {
            name: "noise".into(),
            unit: "px".into(),
            xs: (0..=width).map(|x| x as f64).collect(),
            ys: (0..=height).map(|y| y as f64).collect(),
            labels: LABELS.map(String::from).to_vec(),
            cells,
        })
    })
}

fn any_parameters() -> impl Strategy<Value = Parameters> {
    let extent = prop_oneof![
        Just(Extent::Line),
        Just(Extent::Scope),
        Just(Extent::Facade)
    ];
    let facing = prop_oneof![Just(Facing::Across), Just(Facing::Adjacent)];
    let bias = || prop_oneof![Just(1.0), 0.01..1.0];
    (0.0..=1.0, bias(), bias(), extent, facing).prop_map(|(alpha, p, h, extent, facing)| {
        Parameters {
            alpha,
            parental_bias: p,
            horizontal_bias: h,
            extent,
            facing,
        }
    })
}

proptest! {
    #[test]
    fn lossless_on_noise(grid in noise(), parameters in any_parameters()) {
        let mut alphabet = Alphabet::default();
        let affinity = learn_affinity([&grid], &mut alphabet, &parameters);
        let labels = alphabet.intern_all(&grid.labels);
        let canvas = Canvas::from_grid(&grid, labels);
        let binary = parse(&canvas, &affinity.normalized(), &parameters).expect("an image");
        let nary = NaryTree::from_binary(&binary);
        // Eq. 9: one rule less for each pair of nested splits in one direction.
        let nested = binary.nodes.iter().map(|node| match node {
            BinaryNode::Split { axis, children, .. } => children.iter().filter(|&&child| {
                matches!(binary.nodes[child as usize], BinaryNode::Split { axis: a, .. } if a == *axis)
            }).count(),
            BinaryNode::Insert(_) => 0,
        }).sum::<usize>();
        prop_assert_eq!(nary.splits(), binary.splits() - nested);
        let grammar = split_grammar(&nary, &alphabet, "noise", "px");
        let facade = derive(&grammar, 0).expect("a valid grammar");
        prop_assert_eq!(first_difference(&grid, &facade), None);
        // Through the rules and back.
        let mut inference = Inference::default();
        let instance = inference.add(&binary);
        prop_assert!(inference.rules.len() <= nary.splits());
        let expanded = inference.rules.expand(&instance).expect("its own instance");
        let layout = expanded.layout(&alphabet, "noise", "px");
        prop_assert_eq!(first_difference(&grid, &layout), None);
    }

    #[test]
    fn affinities_add_up(a in noise(), b in noise()) {
        let mut alphabet = Alphabet::default();
        let parameters = Parameters::COMPRESSION;
        let mut one = learn_affinity([&a], &mut alphabet, &parameters);
        let other = learn_affinity([&b], &mut alphabet, &parameters);
        let mut together = Affinity::new(parameters.facing);
        for grid in [&a, &b] {
            let labels = alphabet.intern_all(&grid.labels);
            together.add(&Canvas::from_grid(grid, labels), alphabet.len());
        }
        one.merge(&other);
        let (sum, together) = (one.normalized(), together.normalized());
        for axis in Axis::BOTH {
            for own in 0..4 {
                for facing in 0..4 {
                    let difference = sum.get(axis, own, facing) - together.get(axis, own, facing);
                    prop_assert!(difference.abs() < 1e-12);
                }
            }
        }
    }
}

#[test]
fn lines_that_cut_an_asset_wait() {
    // The lower window's top would cut the taller one; the wall between them comes first.
    let grid = image(&["0000000", "0110000", "0110110", "0110110", "0000000"]);
    let mut model = Model::fit(std::slice::from_ref(&grid), Parameters::COMPRESSION).expect("fits");
    let tree = NaryTree::from_binary(&model.parse(&grid).expect("an image"));
    let NaryNode::Split { axis, sizes, .. } = &tree.nodes[0] else {
        panic!("one split")
    };
    assert_eq!((*axis, sizes.as_slice()), (Axis::Y, &[1.0, 3.0, 1.0][..]));
    assert_eq!(model.inference.forced, 0);
}

#[test]
fn a_pinwheel_is_split_all_the_same() {
    let grid = image(&["0003", "1333", "1332", "1222"]);
    let pinwheel = image(&["003", "123", "122"]);
    for grid in [grid, pinwheel] {
        let model = Model::fit(std::slice::from_ref(&grid), Parameters::COMPRESSION).expect("fits");
        let layout = model.layout(&model.facades[0]).expect("its own facade");
        assert_eq!(first_difference(&grid, &layout), None);
    }
}

#[test]
fn similar_facades_share_one_starting_rule() {
    let narrow = image(&["0000000", "0101010", "0000000"]);
    let wide = image(&["000000000", "011010110", "011010110", "000000000"]);
    let model = Model::fit(&[narrow, wide], Parameters::COMPRESSION).expect("fits");
    assert_eq!(
        model.facades[0].instance.start,
        model.facades[1].instance.start
    );
    assert_eq!(model.inference.rules.len(), 2);
    let start = &model.inference.rules.rules()[1];
    assert_eq!(
        (start.uses, start.mean.as_slice()),
        (2, &[1.0, 1.5, 1.0][..])
    );
    assert_eq!(start.parameters, 3 + 7);
}

#[test]
fn a_facade_is_added_online() {
    let grids: Vec<LabelGrid> = (0..20).map(regular).collect();
    let mut model = Model::fit(&grids[..10], Parameters::COMPRESSION).expect("fits");
    let before = model.clone();
    let mut strange = grids[15].clone();
    strange.labels[1] = "oculus".into();
    model.add_all(&[strange.clone()]).expect("an image");
    assert_eq!(model.facades[..10], before.facades[..]);
    assert_eq!(model.affinity, before.affinity);
    let rules = before.inference.rules.len();
    for (old, new) in before
        .inference
        .rules
        .rules()
        .iter()
        .zip(model.inference.rules.rules())
    {
        assert_eq!((old.axis, &old.children), (new.axis, &new.children));
    }
    assert!(model.inference.rules.len() > rules);
    let layout = model.layout(&model.facades[10]).expect("known");
    assert_eq!(first_difference(&strange, &layout), None);
    assert!(layout.regions.iter().any(|region| region.label == "oculus"));
}

#[test]
fn one_by_one_or_all_at_once_with_one_thread_or_many() {
    let grids: Vec<LabelGrid> = (0..600).map(regular).collect();
    let parameters = Parameters::COMPRESSION;
    let mut alphabet = Alphabet::default();
    let affinity = learn_affinity(&grids, &mut alphabet, &parameters);
    let coefficients = affinity.normalized();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        let mut inference = Inference::default();
        let mut starts = Vec::new();
        pool.install(|| {
            inference.add_all(
                &grids,
                &mut alphabet.clone(),
                &coefficients,
                &parameters,
                |instance| {
                    starts.push(instance);
                },
            )
        })
        .expect("images");
        (inference, starts)
    };
    let one = run(1);
    assert_eq!(one, run(3));
    let mut single = Inference::default();
    for (grid, start) in grids.iter().zip(&one.1) {
        let labels = alphabet.intern_all(&grid.labels);
        let tree = parse(&Canvas::from_grid(grid, labels), &coefficients, &parameters);
        assert_eq!(&single.add(&tree.expect("an image")), start);
    }
    assert_eq!(single, one.0);
}

#[test]
fn profiles_survive_the_way_through_the_parameters() {
    let grids: Vec<LabelGrid> = (0..12).map(regular).collect();
    let mut model = Model::fit(&grids, Parameters::COMPRESSION).expect("fits");
    let profiles = model.profiles().expect("its own facades");
    for (index, grid) in grids.iter().enumerate() {
        let tree = model.parse(grid).expect("an image");
        let start = model.facades[index].instance.start;
        let direct = Profile::new(&tree, &model.inference.rules, start, Lattice::read(grid));
        assert_eq!(direct, profiles[index], "{index}");
    }
}

#[test]
fn nothing_to_learn_from() {
    let error = Model::fit(&[], Parameters::COMPRESSION).map(|_| ());
    assert_eq!(
        error.map_err(|e| e.to_string()),
        Err("no facades to learn from".into())
    );
    let bad = Parameters {
        horizontal_bias: 0.0,
        ..Parameters::COMPRESSION
    };
    let error = Model::fit(&[regular(0)], bad).map(|_| ());
    assert_eq!(
        error.map_err(|e| e.to_string()),
        Err("b_h is 0, expected a number in (0, 1]".into())
    );
}
