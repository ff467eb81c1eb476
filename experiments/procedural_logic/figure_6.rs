//! Fig. 6: virtual facades, and whether they keep to their examples.

use super::data::sources;
use super::words::Structure;
use super::{data_table, row};
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_frame::picture::tiles;
use edifice_procedural_logic::{Instance, Known, Model, Parameters, Style, starting_rules, vector};
use edifice_report::Figure;
use nalgebra::{DMatrix, DVector};

/// Scales of the deviations, one column of the figure each.
const SIGMAS: [f64; 4] = [0.25, 0.5, 1.0, 2.0];
/// Starting rules, one row of the figure each.
const STARTS: usize = 4;
/// Fewest facades that a starting rule must have for its correlations to be compared.
const FEWEST: usize = 5;

/// Draws facades for the most frequent starting rules, and tests many more.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let count = ctx.budget().choose(100, 1000, 1000);
    ctx.setting("facades", count);
    let mut table = data_table(
        format!("{count} virtual facades per starting rule and sigma"),
        &["starting rule"],
        &[
            "examples",
            "sigma",
            "invalid",
            "pairs",
            "rms z",
            "within 1.96",
            "rms z, exact",
        ],
    );
    for source in sources(ctx)? {
        let model = Model::fit(&source.grids, Parameters::COMPRESSION).map_err(Error::method)?;
        let mut figure = Figure::new("Virtual facades: starting rules by sigma", SIGMAS.len() + 1)
            .cell(240.0, 300.0);
        let starts = starting_rules(&model)
            .into_iter()
            .filter(|start| start.1 >= FEWEST);
        for (place, (start, examples)) in starts.take(STARTS).enumerate() {
            let style = Style::learn(&model, start).map_err(Error::method)?;
            let known: Vec<&Known> = model
                .facades
                .iter()
                .filter(|k| k.instance.start == start)
                .collect();
            let training: Vec<DVector<f64>> = known.iter().map(|k| vector(&k.instance)).collect();
            let wanted = correlations(&training);
            let layout = model.layout(known[0]).map_err(Error::method)?;
            figure =
                figure.panel(tiles(format!("given: {}", known[0].name), &layout).without_borders());
            let words = Structure::new(&model.inference.rules, &model.alphabet, start);
            let words = words.map_or_else(|| format!("{start:?}"), |w| w.sentence());
            for sigma in SIGMAS {
                let stream_name = format!("{} {sigma}", source.dataset);
                let mut rng = stream(ctx.seed(), &stream_name, place as u64);
                let drawn: Vec<Instance> = (0..count)
                    .map(|_| style.sample(sigma, &mut rng))
                    .collect::<std::result::Result<_, _>>()
                    .map_err(Error::method)?;
                let mut invalid = 0;
                for (index, instance) in drawn.iter().enumerate() {
                    let virtual_facade = Known {
                        name: format!("sigma = {sigma}"),
                        unit: style.unit.clone(),
                        instance: instance.clone(),
                    };
                    let layout = model.layout(&virtual_facade).map_err(Error::method)?;
                    let positive = instance.parameters.iter().all(|&size| size > 0.0);
                    invalid += usize::from(!positive || layout.check_tiling().is_err());
                    if index == 0 {
                        figure =
                            figure.panel(tiles(virtual_facade.name, &layout).without_borders());
                    }
                }
                let vectors: Vec<DVector<f64>> = drawn.iter().map(vector).collect();
                let found = correlations(&vectors);
                let both = scores(
                    &wanted,
                    &found,
                    1.0 / (examples - 3) as f64 + 1.0 / (count - 3) as f64,
                );
                let exact = scores(&wanted, &found, 1.0 / (count - 3) as f64);
                let within = both.iter().filter(|z| z.abs() < 1.96).count() as f64
                    / both.len().max(1) as f64;
                table.row([
                    source.dataset.to_owned(),
                    words.clone(),
                    examples.to_string(),
                    sigma.to_string(),
                    invalid.to_string(),
                    both.len().to_string(),
                    format!("{:.2}", rms(&both)),
                    format!("{:.1} %", 100.0 * within),
                    format!("{:.2}", rms(&exact)),
                ]);
                let instance = format!("start_{} sigma={sigma}", place + 1);
                for (metric, value) in [
                    ("invalid", invalid as f64),
                    ("correlation_rms_z", rms(&both)),
                    ("correlation_within_1.96", within),
                    ("correlation_rms_z_exact", rms(&exact)),
                ] {
                    ctx.observe(row(source.dataset, "pca", &instance, metric, value));
                }
            }
        }
        if source.pictured {
            ctx.figure(&source.figure("figure_6"), &figure)?;
        }
    }
    ctx.table(&table);
    ctx.note(
        "Invalid would be a facade with a size that is not positive, or that is no tiling. The \
         correlations of all pairs of parameters are compared with those of the examples by Fisher's z \
         (difference of their inverse hyperbolic tangents over its standard error): *rms z* with the \
         error of both samples, which is about 1 or less when they differ by sampling alone; *exact* with \
         the error of the drawn sample only, as if the examples were the whole truth: there the price of \
         throwing away draws with sizes that are not positive shows from sigma 1 on.",
    );
    Ok(())
}

/// Correlation matrix; not a number where a parameter does not vary.
fn correlations(vectors: &[DVector<f64>]) -> DMatrix<f64> {
    let mean = vectors.iter().sum::<DVector<f64>>() / vectors.len() as f64;
    let centred: Vec<DVector<f64>> = vectors.iter().map(|v| v - &mean).collect();
    let matrix = DMatrix::from_columns(&centred);
    let covariance = &matrix * matrix.transpose();
    let p = mean.len();
    DMatrix::from_fn(p, p, |i, j| {
        let scale = (covariance[(i, i)] * covariance[(j, j)]).sqrt();
        let varies = |k: usize| covariance[(k, k)] > 1e-9 * vectors.len() as f64;
        if varies(i) && varies(j) {
            covariance[(i, j)] / scale
        } else {
            f64::NAN
        }
    })
}

/// Fisher's z of each pair of parameters that is not tied by an equation.
fn scores(wanted: &DMatrix<f64>, found: &DMatrix<f64>, variance: f64) -> Vec<f64> {
    let mut scores = Vec::new();
    for i in 0..wanted.nrows() {
        for j in 0..i {
            let (a, b) = (wanted[(i, j)], found[(i, j)]);
            if a.abs() < 1.0 - 1e-6 && b.abs() < 1.0 - 1e-6 {
                scores.push((a.atanh() - b.atanh()) / variance.sqrt());
            }
        }
    }
    scores
}

fn rms(values: &[f64]) -> f64 {
    let sum: f64 = values.iter().map(|v| v * v).sum();
    (sum / values.len().max(1) as f64).sqrt()
}
