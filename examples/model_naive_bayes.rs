//! Naive Bayes with a hidden class and missing cells, learned by EM.
//! `cargo run --example model_naive_bayes --no-default-features`

use edifice::model::network::{Evidence, FitSettings, Network, Variable};
use edifice::model::{ModelError, Table};
use edifice::rng::stream;
use rand::RngExt;

fn main() -> Result<(), ModelError> {
    // Two kinds of buildings that nobody has labelled: houses and towers. Every tenth cell is not known.
    let mut rng = stream(1, "buildings", 0);
    let (mut garden, mut lift, mut floors) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..300 {
        let tower = i % 3 == 0;
        let mut known = || rng.random::<f64>() > 0.1;
        let (a, b, c) = (known(), known(), known());
        garden.push(a.then_some(rng.random::<f64>() < if tower { 0.1 } else { 0.8 }));
        lift.push(b.then_some(rng.random::<f64>() < if tower { 0.95 } else { 0.05 }));
        let height = if tower { 12.0 } else { 2.0 };
        floors.push(c.then_some(height * (0.8 + 0.4 * rng.random::<f64>())));
    }
    let data = Table::new().binary("garden", garden)?;
    let data = data.binary("lift", lift)?.real("floors", floors)?;

    // A variable without a column is hidden.
    let network = Network::new(vec![
        Variable::discrete("kind", &["a", "b"], &[]),
        Variable::discrete("garden", &["no", "yes"], &["kind"]),
        Variable::discrete("lift", &["no", "yes"], &["kind"]),
        Variable::continuous("floors", 1, &["kind"]),
    ])?;
    let fitted = network.fit(&data, &FitSettings::default(), &mut rng)?;
    let per_row = fitted.log_likelihood / 300.0;
    println!(
        "{per_row:.2} nats a building after {} rounds of EM",
        fitted.trace.len()
    );

    let learned = fitted.network;
    let given = Evidence::new().is("garden", "yes").real("floors", &[2.2]);
    let (kind, lift) = (
        learned.marginal(&given, "kind")?,
        learned.marginal(&given, "lift")?,
    );
    println!(
        "two floors and a garden: kind {kind:.3?}, a lift {:.3}",
        lift[1]
    );
    assert!(lift[1] < 0.2);
    Ok(())
}
