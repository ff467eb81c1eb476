//! Fig. 10: the facades.

use super::{data, picture};
use edifice_base::Result;
use edifice_frame::Context;
use edifice_report::{Figure, Row};

/// Shows every shipped facade with its number of terminals.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let facades = data::shipped(ctx)?;
    let mut figure = Figure::new("the shipped facades", 7).cell(150.0, 180.0);
    for facade in &facades {
        let terminals = facade.regions.len();
        let caption = format!("{terminals} terminals");
        figure = figure.panel(picture::tiles(&facade.name, facade).caption(caption));
        ctx.observe(Row {
            dataset: "shipped".into(),
            instance: facade.name.clone(),
            metric: "terminals".into(),
            value: terminals as f64,
            ..Row::default()
        });
    }
    ctx.figure("figure_10", &figure)?;
    let counts = facades.iter().map(|f| f.regions.len());
    let range = (counts.clone().min(), counts.max());
    if let (Some(low), Some(high)) = range {
        ctx.compare(
            "terminals, fewest to most",
            "50 to 1121",
            format!("{low} to {high}"),
        );
    }
    ctx.compare(
        "facades in the data set",
        "34",
        format!("{}", facades.len()),
    );
    ctx.note(
        "The paper's own facades are not public, but for that of Fig. 9, whose printed grammar gives its layout. The \
         others are made by a seeded generator of this project (`datasets/facade_grammar/README.md`).",
    );
    Ok(())
}
