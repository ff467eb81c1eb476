//! Coherent completions: made grids come back exactly, nothing overlaps, new windows stand on lines, masses do not depend on
//! how many answers are asked for.

use edifice::methods::structure_completion::layout::lines::numbers;
use edifice::methods::structure_completion::layout::{Class, Element, Layout};
use edifice::methods::structure_completion::made::{facades, grids};
use edifice::methods::structure_completion::measure::{agreement, off_lines, overlaps};
use edifice::methods::structure_completion::method::{Method, complete};
use edifice::methods::structure_completion::model::shipped_model;
use edifice::methods::structure_completion::partial::PartialLayout;
use edifice::methods::structure_completion::task::Task;
use edifice::rng::stream;
use edifice::shape::Rect;

use crate::doors::doors_and_alone;

fn added(
    completion: &edifice::methods::structure_completion::completion::Completion,
) -> Vec<Element> {
    completion.added.iter().map(|a| a.element).collect()
}

#[test]
fn made_grids_are_completed_perfectly() {
    let model = shipped_model().expect("the shipped model");
    for (sight, least) in grids::Sight::ALL.into_iter().zip([23, 23, 23, 20]) {
        let mut perfect = 0;
        for (k, (layout, size)) in grids::all(5).iter().enumerate() {
            let mut rng = stream(5, sight.name(), k as u64);
            let (partial, hidden) = sight.of(layout, *size, &mut rng);
            let done = complete(Method::Best, &partial, &model, 1, &mut rng);
            perfect += usize::from(agreement(&added(&done[0]), &hidden, 0.9).f1 == 1.0);
        }
        assert!(
            perfect >= least,
            "{}: {perfect} of {}",
            sight.name(),
            grids::COUNT
        );
    }
}

/// Made facades, some of which have annotation errors, with each part hidden.
fn cases() -> Vec<(PartialLayout, Layout)> {
    let made = |k: u64| {
        let layout = facades::facade(k as usize, &mut stream(6, "facade", k));
        let task = Task::ALL[k as usize % Task::ALL.len()];
        (task.hide(&layout, &mut stream(6, "mask", k)).0, layout)
    };
    (0..60).map(made).collect()
}

#[test]
fn every_answer_is_coherent() {
    let model = shipped_model().expect("the shipped model");
    let (mut windows, mut off) = (0, 0);
    for (k, (partial, _)) in cases().iter().enumerate() {
        let mut rng = stream(6, "complete", k as u64);
        for answer in complete(Method::Best, partial, &model, 5, &mut rng) {
            let added = added(&answer);
            assert_eq!(overlaps(&partial.observed, &added), 0, "{k}");
            windows += added.iter().filter(|e| e.class == Class::Window).count();
            off += off_lines(&partial.observed, &added);
        }
    }
    assert!(off as f64 <= 0.01 * windows as f64, "{off} of {windows}");
}

#[test]
fn the_mass_of_an_answer_does_not_depend_on_their_number() {
    let model = shipped_model().expect("the shipped model");
    for (k, (partial, _)) in cases().iter().enumerate().step_by(4) {
        let answers = |count: usize| {
            let mut rng = stream(7, "complete", k as u64);
            complete(Method::Best, partial, &model, count, &mut rng)
        };
        let all = answers(100);
        let mass: f64 = all.iter().map(|a| a.mass).sum();
        // Half of what the learnt probabilities leave belongs to the answers.
        assert!((0.5 - 1e-9..=1.0 + 1e-9).contains(&mass), "{mass}");
        let best = all.iter().map(|a| a.score).fold(0.0, f64::max);
        assert_eq!(all[0].score, best);
        for count in [1, 2, 5] {
            let some = answers(count);
            assert_eq!(some[..], all[..count.min(all.len())]);
        }
    }
}

/// Each answer stands for its numbers of columns and rows, counted as those of the truth are: no other has them. An exact lattice is
/// put before them.
#[test]
fn answers_have_different_numbers_of_columns_and_rows() {
    let model = shipped_model().expect("the shipped model");
    let mut several = 0;
    for (k, (partial, _)) in cases().iter().enumerate().step_by(3) {
        let mut rng = stream(9, "numbers", k as u64);
        let answers = complete(Method::Best, partial, &model, 100, &mut rng);
        let is_exact = |a: &&edifice::methods::structure_completion::completion::Completion| {
            !a.added.is_empty() && a.added.iter().all(|e| e.probability == 0.9)
        };
        let found = answers.iter().filter(|a| !is_exact(a)).map(|a| {
            let new = added(a);
            numbers(partial.observed.iter().chain(&new))
        });
        let mut found: Vec<(usize, usize)> = found.collect();
        let all = found.len();
        several += usize::from(all > 1);
        found.sort_unstable();
        found.dedup();
        assert_eq!(found.len(), all, "case {k}");
    }
    assert!(several > 5, "{several}");
}

#[test]
fn a_thing_that_is_drawn_twice_counts_once() {
    let window = |x: f64| Element::new(Class::Window, Rect::new(x, 10.0, 10.0, 10.0));
    let partial = PartialLayout {
        width: 100.0,
        height: 50.0,
        observed: vec![window(0.0), window(1.0), window(30.0), window(38.0)],
        unknown: None,
        forbidden: Vec::new(),
    };
    let overlaps = partial.overlaps();
    let found: Vec<_> = overlaps
        .iter()
        .map(|o| (o.first, o.second, o.twice))
        .collect();
    assert_eq!(found, [(0, 1, true), (2, 3, false)]);
    let merged = partial.without_duplicates();
    assert_eq!(merged.observed, [window(0.0), window(30.0), window(38.0)]);
    let model = shipped_model().expect("the shipped model");
    for method in Method::ALL.into_iter().filter(|m| !m.is_slow()) {
        let mut rng = stream(8, "twice", 0);
        assert!(!complete(method, &partial, &model, 1, &mut rng).is_empty());
    }
}

/// True if a window lacks a column or a row among other elements.
fn is_off(elements: &[Element], window: &Element) -> bool {
    let others: Vec<Element> = elements.iter().filter(|e| *e != window).copied().collect();
    off_lines(&others, &[*window]) == 1
}

/// The shipped layouts with each part hidden: no warning about the input, nothing overlaps, and of the new windows no more than 1.5 %
/// lack a column or a row, those aside that stand where the whole facade has a row off its columns too (a ground floor, the
/// windows under the roof); and in all no greater share than of the windows that were hidden.
#[test]
fn shipped_layouts_are_completed_on_lines() {
    let model = shipped_model().expect("the shipped model");
    let shipped = model.layouts().into_iter();
    let shipped: Vec<Layout> = shipped.filter(|l| !l.name.starts_with("made_")).collect();
    assert!(shipped.len() > 30);
    let (mut windows, mut off, mut amiss) = (0, 0, 0);
    let (mut hidden, mut hidden_off) = (0, 0);
    for (k, layout) in shipped.iter().enumerate() {
        let is_window = |e: &&Element| e.class == Class::Window;
        let true_off: Vec<&Element> = (layout.elements.iter().filter(is_window))
            .filter(|e| is_off(&layout.elements, e))
            .collect();
        for task in Task::ALL {
            let mut rng = stream(9, task.name(), k as u64);
            let (partial, truth) = task.hide(layout, &mut rng);
            assert_eq!(partial.overlaps(), [], "{}", layout.name);
            let done = complete(Method::Best, &partial, &model, 1, &mut rng);
            let added = added(&done[0]);
            assert_eq!(overlaps(&partial.observed, &added), 0, "{}", layout.name);
            let whole: Vec<Element> = partial.observed.iter().chain(&added).copied().collect();
            for window in added.iter().filter(is_window) {
                windows += 1;
                if is_off(&whole, window) {
                    off += 1;
                    let (_, y) = window.rect.centre();
                    let in_row =
                        |e: &&Element| (e.rect.centre().1 - y).abs() < 0.25 * e.rect.height;
                    amiss += usize::from(!true_off.iter().any(in_row));
                }
            }
            hidden += truth.iter().filter(is_window).count();
            hidden_off += true_off.iter().filter(|e| truth.contains(e)).count();
        }
    }
    println!(
        "{off} of {windows} new windows lack a column or a row, {amiss} of them where no true one does; {hidden_off} of {hidden} hidden ones"
    );
    assert!(
        amiss as f64 <= 0.015 * windows as f64,
        "{amiss} of {windows}"
    );
    assert!(
        off * hidden <= hidden_off * windows,
        "{off} of {windows}, {hidden_off} of {hidden}"
    );
}

/// The gap between two windows that stand beside or above each other over at least half of the smaller one; `None` for others.
fn gaps(a: &Rect, b: &Rect) -> [Option<f64>; 2] {
    let x = a.x.max(b.x) - a.right().min(b.right());
    let y = a.y.max(b.y) - a.top().min(b.top());
    [
        (-y >= 0.5 * a.height.min(b.height)).then_some(x),
        (-x >= 0.5 * a.width.min(b.width)).then_some(y),
    ]
}

/// With a mask, no new window is closer to another one than half of the least of three or more gaps seen.
#[test]
fn windows_keep_their_distance() {
    let model = shipped_model().expect("the shipped model");
    let (mut asked, mut answers) = (0, 0);
    for (k, layout) in model.layouts().into_iter().enumerate() {
        for task in Task::ALL {
            let mut rng = stream(11, task.name(), k as u64);
            let (partial, _) = task.hide(&layout, &mut rng);
            if partial.unknown.is_none() {
                continue;
            }
            let seen: Vec<Rect> = partial.of(Class::Window).map(|w| w.rect).collect();
            let mut least = [(0, f64::INFINITY); 2];
            for (i, a) in seen.iter().enumerate() {
                for (found, gap) in seen[..i]
                    .iter()
                    .flat_map(|b| [0, 1].into_iter().zip(gaps(a, b)))
                {
                    if let Some(gap) = gap {
                        least[found] = (least[found].0 + 1, least[found].1.min(gap));
                    }
                }
            }
            for answer in complete(Method::Best, &partial, &model, 3, &mut rng) {
                answers += 1;
                let new = added(&answer);
                let new = new.iter().filter(|e| e.class == Class::Window);
                let mut others = seen.clone();
                for window in new {
                    for other in &others {
                        for (gap, (count, least)) in
                            gaps(&window.rect, other).into_iter().zip(least)
                        {
                            if let Some(gap) = gap.filter(|_| count >= 3 && least > 0.0) {
                                asked += 1;
                                let slack = 1e-9 * partial.width;
                                assert!(
                                    gap >= 0.5 * least - slack,
                                    "{}, {task:?}: {gap}",
                                    layout.name
                                );
                            }
                        }
                    }
                    others.push(window.rect);
                }
            }
        }
    }
    println!("{answers} answers, {asked} gaps");
    assert!(answers > 500 && asked > 50_000);
}

#[test]
fn a_facade_gets_one_door_and_no_second_beside_a_seen_one() {
    let model = shipped_model().expect("the shipped model");
    for (k, (partial, _)) in cases().iter().enumerate() {
        let mut rng = stream(10, "complete", k as u64);
        let seen = partial.of(Class::Door).count();
        for answer in complete(Method::Best, partial, &model, 3, &mut rng) {
            let doors = added(&answer)
                .iter()
                .filter(|e| e.class == Class::Door)
                .count();
            assert!(
                doors <= usize::from(seen == 0),
                "{k}: {seen} seen, {doors} added"
            );
        }
    }
}

/// Windows of one row that are of one width, `with` of `all` before which a balcony hangs.
fn rows_of_balconies(elements: &[Element], upper: f64) -> Vec<(usize, usize)> {
    let of = |class| {
        elements
            .iter()
            .filter(move |e| e.class == class)
            .map(|e| e.rect)
    };
    let mut rows: Vec<Vec<Rect>> = Vec::new();
    for window in of(Class::Window).filter(|w| w.y > upper) {
        let same = |w: &Rect| {
            let near = (w.centre().1 - window.centre().1).abs() < 0.35 * window.height;
            near && (w.width / window.width).ln().abs() < 0.12
        };
        match rows.iter_mut().find(|r| same(&r[0])) {
            Some(row) => row.push(window),
            None => rows.push(vec![window]),
        }
    }
    let hangs = |w: &Rect| {
        of(Class::Balcony).any(|b| {
            let beside = (b.centre().0 - w.centre().0).abs() < 0.5 * w.width;
            beside
                && b.y < w.centre().1
                && b.top() > w.y - 0.5 * w.height
                && b.width < 2.0 * w.width
        })
    };
    let counts = rows
        .iter()
        .map(|r| (r.iter().filter(|w| hangs(w)).count(), r.len()));
    counts.collect()
}

#[test]
fn balconies_are_even_within_a_row() {
    let model = shipped_model().expect("the shipped model");
    let (mut uneven, mut rows) = (0, 0);
    for k in 0..120 {
        let layout = facades::facade(k as usize, &mut stream(11, "facade", k));
        let even = |elements: &[Element]| {
            let rows = rows_of_balconies(elements, 0.2 * layout.height);
            (
                rows.iter().filter(|r| r.0 > 0 && r.0 < r.1).count(),
                rows.iter().filter(|r| r.0 > 0).count(),
            )
        };
        // Facades whose balconies are even themselves.
        if even(&layout.elements).0 > 0 || even(&layout.elements).1 == 0 {
            continue;
        }
        let mut rng = stream(11, "mask", k);
        let (partial, _) = Task::Side50.hide(&layout, &mut rng);
        let done = complete(Method::Best, &partial, &model, 1, &mut rng);
        let whole: Vec<Element> = partial
            .observed
            .iter()
            .copied()
            .chain(added(&done[0]))
            .collect();
        let (own, all) = even(&whole);
        uneven += own;
        rows += all;
    }
    println!("{uneven} of {rows} rows are uneven");
    assert!(rows > 20 && uneven * 8 <= rows, "{uneven} of {rows}");
}

/// Doors that are added where a ground floor is hidden stand there alone in at most 8 of 100 cases. Of the true doors of the layouts that
/// ship 9 of 160 do, of those of CMP 7 in 100 (`real_data`: `new_doors_of_cmp_stand_alone_no_more_often_than_true_ones`).
#[test]
fn new_doors_do_not_stand_alone() {
    let model = shipped_model().expect("the shipped model");
    let ([mut doors, mut alone], mut of_truth) = ([0, 0], [0, 0]);
    for (k, layout) in model.layouts().into_iter().enumerate() {
        let [all, lone] = doors_and_alone(&layout.elements, &layout.elements);
        of_truth = [of_truth[0] + all, of_truth[1] + lone];
        for task in [Task::Bottom40, Task::Corner36] {
            let mut rng = stream(12, task.name(), k as u64);
            let (partial, _) = task.hide(&layout, &mut rng);
            let done = complete(Method::Best, &partial, &model, 1, &mut rng);
            let new = added(&done[0]);
            let all: Vec<Element> = partial.observed.iter().chain(&new).copied().collect();
            let [all, lone] = doors_and_alone(&new, &all);
            (doors, alone) = (doors + all, alone + lone);
        }
    }
    println!("{alone} of {doors} new doors alone; true doors, alone: {of_truth:?}");
    assert!(doors > 50 && 100 * alone <= 8 * doors);
}
