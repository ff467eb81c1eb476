//! Attributes of houses as a program, equal to elimination in the hierarchical model that was learned of them.

use edifice_model::Table;
use edifice_model::hierarchy::{Group, Hierarchy, Settings, Variant, learn};
use edifice_model::network::Network;
use edifice_model::program::dist::{categorical, normal};
use edifice_model::program::{Handler, Program, exact};

const ROOFS: [&str; 3] = ["flat", "gable", "hip"];

/// The known attributes of a house: width, depth, garage, roof.
#[derive(Clone, Copy)]
struct House(Option<f64>, Option<f64>, Option<usize>, Option<usize>);

/// Small houses and large ones, of two kinds each.
fn house(i: usize) -> House {
    let noise = |m: usize| ((i * 7919 + m * 104_729) % 1009) as f64 / 1009.0 - 0.5;
    let large = i % 5 < 2;
    let width = [7.0, 14.0][usize::from(large)] + 3.0 * f64::from(u8::from(i.is_multiple_of(3)));
    let garage = usize::from(large != (i.is_multiple_of(11)));
    let roof = if large { i % 2 } else { 1 + i % 7 / 5 };
    House(
        Some(width + noise(1)),
        Some([8.0, 11.0][usize::from(large)] + 2.0 * noise(2)),
        Some(garage),
        Some(roof),
    )
}

fn table(houses: &[House]) -> Table {
    let table = Table::new()
        .real("width", houses.iter().map(|h| h.0))
        .and_then(|t| t.real("depth", houses.iter().map(|h| h.1)))
        .and_then(|t| t.binary("garage", houses.iter().map(|h| h.2.map(|g| g == 1))))
        .and_then(|t| t.codes("roof", &ROOFS, houses.iter().map(|h| h.3)));
    table.unwrap()
}

/// The style, then the kind of each real attribute, then the attributes.
struct Attributes<'a> {
    model: &'a Hierarchy,
    network: &'a Network,
    known: House,
}

impl Program for Attributes<'_> {
    type Out = ();
    fn run<H: Handler>(&self, h: &mut H) {
        let style = h.sample("style", categorical(self.model.style_probabilities()));
        for (name, seen) in [("width", self.known.0), ("depth", self.known.1)] {
            let kinds = &self.model.state_probabilities(name).unwrap()[style];
            let kind = h.sample(format!("{name} kind"), categorical(kinds));
            let (mean, variance) = self.network.regression(name, kind).unwrap();
            if let Some(x) = seen {
                h.observe(normal(mean[0], variance[0].sqrt()), &x.into());
            }
        }
        for (name, seen) in [("garage", self.known.2), ("roof", self.known.3)] {
            let shares = &self.model.category_probabilities(name).unwrap()[style];
            match seen {
                Some(code) => h.observe(categorical(shares), &code),
                None => {
                    h.sample(name, categorical(shares));
                }
            }
        }
    }
}

#[test]
fn attributes_of_houses_are_those_of_elimination() {
    let houses: Vec<House> = (0..240).map(house).collect();
    let groups = ["width", "depth", "garage", "roof"].map(|name| Group::new(name, &[name]));
    let settings = Settings {
        styles: 2..=3,
        variant: Variant::NoLateral,
        ..Settings::default()
    };
    let model = learn(&table(&houses), &groups, &settings, 1).unwrap().model;
    let network = model.to_network().unwrap();
    let log = |house: House| model.log_likelihood(&table(&[house])).unwrap()[0];
    for i in 0..40 {
        let House(width, depth, garage, roof) = house(i * 6 + 1);
        let known = House(
            width.filter(|_| i % 2 == 0),
            depth.filter(|_| i % 3 > 0),
            garage.filter(|_| i % 4 == 1),
            roof.filter(|_| i % 5 > 2),
        );
        let program = Attributes {
            model: &model,
            network: &network,
            known,
        };
        let posterior = exact(&program).unwrap();
        let evidence = posterior.evidence.unwrap().log;
        assert!((evidence - log(known)).abs() < 1e-9, "{i}");
        let row = table(&[known]);
        let styles = &model.style_posterior(&row).unwrap()[0];
        for (s, p) in styles.iter().enumerate() {
            let found = posterior.probability("style", s as u64).mean;
            assert!((found - p).abs() < 1e-9, "{i}: style {s}");
        }
        for name in ["width", "depth"] {
            let kinds = &model.state_posterior(&row, name).unwrap()[0];
            for (k, p) in kinds.iter().enumerate() {
                let found = posterior.probability(format!("{name} kind"), k as u64).mean;
                assert!((found - p).abs() < 1e-9, "{i}: kind {k} of {name}");
            }
        }
        if known.3.is_none() {
            for r in 0..ROOFS.len() {
                let with = House(known.0, known.1, known.2, Some(r));
                let p = (log(with) - log(known)).exp();
                let found = posterior.probability("roof", r as u64).mean;
                assert!((found - p).abs() < 1e-9, "{i}: roof {r}");
            }
        }
    }
}
