use super::*;

/// Copies of a pattern of three symbols, turned, far from each other.
fn copies(n: usize) -> (Vec<Posed>, Vec<(usize, usize)>) {
    let pattern = [
        ([0.0, 0.0], 0.0),
        ([20.0, 0.0], 30.0),
        ([20.0, 15.0], 200.0),
    ];
    let (mut posed, mut near) = (Vec::new(), Vec::new());
    for i in 0..n {
        let frame = Posed {
            kind: 0,
            at: [500.0 * i as f64, 40.0, 0.0],
            turn: 37.0 * i as f64,
        };
        let first = posed.len();
        for (kind, &([x, y], turn)) in pattern.iter().enumerate() {
            let at = [x, y, 0.0];
            posed.push(placed(&Posed { kind, at, turn }, &frame));
        }
        near.extend([
            (first, first + 1),
            (first + 1, first + 2),
            (first, first + 2),
        ]);
    }
    (posed, near)
}

#[test]
fn what_stands_together_is_one_rule() {
    let (posed, near) = copies(5);
    let rules = repeated(&posed, 3, &[false; 3], &near);
    assert_eq!(rules.len(), 1);
    assert_eq!(rules[0].count, 5);
    let mut kinds: Vec<usize> = rules[0].members.iter().map(|m| m.kind).collect();
    kinds.sort_unstable();
    assert_eq!(kinds, [0, 1, 2]);
    // The rule at an occurrence of its first member gives the others.
    let first = &rules[0].members[0];
    let anchor = posed[first.kind];
    let turn = anchor.turn - first.turn;
    let (sin, cos) = turn.to_radians().sin_cos();
    let [x, y, _] = first.at;
    let frame = Posed {
        kind: 0,
        at: [
            anchor.at[0] - x * cos + y * sin,
            anchor.at[1] - x * sin - y * cos,
            0.0,
        ],
        turn,
    };
    for m in &rules[0].members {
        let found = placed(m, &frame);
        let true_one = posed[m.kind];
        assert!(length([0, 1, 2].map(|k| found.at[k] - true_one.at[k])) < 1e-9);
        assert!(wrapped(found.turn - true_one.turn).abs() < 1e-9);
    }
}

#[test]
fn half_turns_of_symmetric_symbols_do_not_matter() {
    let (mut posed, near) = copies(6);
    for p in posed.iter_mut().step_by(2) {
        p.turn += 180.0;
    }
    let rules = repeated(&posed, 3, &[true; 3], &near);
    assert_eq!((rules.len(), rules[0].count), (1, 6));
}

#[test]
fn chance_makes_no_rule() {
    let (posed, near) = copies(LEAST - 1);
    assert!(repeated(&posed, 3, &[false; 3], &near).is_empty());
}

#[test]
fn a_row_of_one_symbol_is_a_rule_of_rules() {
    let row = |i: usize| Posed {
        kind: 0,
        at: [10.0 * i as f64, 0.0, 0.0],
        turn: 0.0,
    };
    let posed: Vec<Posed> = (0..24).map(row).collect();
    let near: Vec<_> = (1..24).map(|i| (i - 1, i)).collect();
    let rules = repeated(&posed, 1, &[false], &near);
    assert_eq!(rules[0].count, 12);
    let shift = rules[0].members[1].at[0].abs();
    assert!((shift - 10.0).abs() < 1e-9, "{shift}");
    assert!(rules.len() > 1);
}
