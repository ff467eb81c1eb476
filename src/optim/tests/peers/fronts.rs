//! Fronts of several costs, beside pymoo.

use edifice_base::rng::stream;
use edifice_optim::nsga::{Reals, Settings as Nsga, evolve};
use rand::RngExt;

/// Hypervolumes after 100 x 250 evaluations; pymoo's of three seeds.
#[test]
fn fronts_are_as_large_as_pymoos() {
    let sum = |x: &[f64]| 1.0 + 9.0 * x[1..].iter().sum::<f64>() / (x.len() - 1) as f64;
    type Costs = Box<dyn Fn(&[f64]) -> Vec<f64>>;
    let pi = std::f64::consts::PI;
    let zdt = |second: fn(f64, f64) -> f64| -> Costs {
        Box::new(move |x| vec![x[0], second(x[0], sum(x))])
    };
    let dtlz2: Costs = Box::new(move |x| {
        let g: f64 = x[2..].iter().map(|x| (x - 0.5).powi(2)).sum();
        let (a, b) = (x[0] * pi / 2.0, x[1] * pi / 2.0);
        vec![
            (1.0 + g) * a.cos() * b.cos(),
            (1.0 + g) * a.cos() * b.sin(),
            (1.0 + g) * a.sin(),
        ]
    });
    let problems: [(&str, usize, usize, Costs, f64); 4] = [
        (
            "ZDT1",
            30,
            2,
            zdt(|x, g| g * (1.0 - (x / g).sqrt())),
            0.8697,
        ),
        (
            "ZDT2",
            30,
            2,
            zdt(|x, g| g * (1.0 - (x / g).powi(2))),
            0.5364,
        ),
        (
            "ZDT3",
            30,
            2,
            zdt(|x, g| {
                g * (1.0 - (x / g).sqrt() - x / g * (10.0 * std::f64::consts::PI * x).sin())
            }),
            1.3276,
        ),
        ("DTLZ2", 12, 3, dtlz2, 0.7056),
    ];
    for (name, variables, objectives, costs, pymoo) in problems {
        let mut mean = 0.0;
        for seed in 0..3 {
            let mut problem = Reals::new(vec![(0.0, 1.0); variables], objectives, |x: &[f64]| {
                costs(x)
            });
            let front = evolve(&mut problem, &Nsga::default(), seed, |_| {}).unwrap();
            mean += front.hypervolume(&vec![1.1; objectives]) / 3.0;
            assert_eq!(front.evaluations, 100 * 251);
        }
        println!("{name}: hypervolume {mean:.4}, pymoo {pymoo}");
        assert!(mean > pymoo - 0.01, "{name}: {mean} is not {pymoo}");
    }
}

#[test]
fn constraints_are_kept() {
    // Binh and Korn's problem.
    let costs = |x: &[f64]| {
        vec![
            4.0 * (x[0] * x[0] + x[1] * x[1]),
            (x[0] - 5.0).powi(2) + (x[1] - 5.0).powi(2),
        ]
    };
    let violation = |x: &[f64]| {
        let first = (x[0] - 5.0).powi(2) + x[1] * x[1] - 25.0;
        let second = 7.7 - (x[0] - 8.0).powi(2) - (x[1] + 3.0).powi(2);
        first.max(0.0) + second.max(0.0)
    };
    let mut problem = Reals::new(vec![(0.0, 5.0), (0.0, 3.0)], 2, costs).constrained(violation);
    let front = evolve(
        &mut problem,
        &Nsga {
            generations: 60,
            ..Nsga::default()
        },
        1,
        |_| {},
    )
    .unwrap();
    assert!(front.members.len() > 50 && front.members.iter().all(|m| m.violation == 0.0));
    // The ends of the front are (0, 50) and (136, 4).
    let last = &front.members[front.members.len() - 1];
    assert!(
        front.members[0].costs[0] < 1.0 && last.costs[1] < 4.2,
        "{last:?}"
    );
}

#[test]
fn hypervolumes_equal_counts() {
    use edifice_optim::nsga::hypervolume;
    let mut rng = stream(3, "volume", 0);
    for dimension in 2..5 {
        for _ in 0..20 {
            let points: Vec<Vec<f64>> = (0..6)
                .map(|_| {
                    (0..dimension)
                        .map(|_| f64::from(rng.random_range(0..6)))
                        .collect()
                })
                .collect();
            // Unit cubes of a grid below 5 that some point dominates.
            let cells = 5_usize.pow(dimension as u32);
            let inside = (0..cells).filter(|&c| {
                let mut rest = c;
                let cell: Vec<f64> = (0..dimension)
                    .map(|_| {
                        let x = rest % 5;
                        rest /= 5;
                        x as f64
                    })
                    .collect();
                points
                    .iter()
                    .any(|p| p.iter().all(|x| *x < 5.0) && p.iter().zip(&cell).all(|(x, c)| x <= c))
            });
            let volume = hypervolume(&points, &vec![5.0; dimension]);
            assert_eq!(volume, inside.count() as f64, "{points:?}");
        }
    }
}
