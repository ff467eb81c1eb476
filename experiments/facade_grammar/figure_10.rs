//! Fig. 10: the facades.

use super::picture;
use crate::Result;
use crate::experiments::Context;
use crate::report::Figure;

/// Shows every shipped layout.
pub fn run(ctx: &mut Context) -> Result<()> {
    let mut figure = Figure::new("the shipped layouts", 7).cell(210.0, 250.0);
    for m in crate::methods::facade_grammar::synthetic::layouts(1).map_err(crate::Error::method)? {
        figure = figure.panel(
            picture::tiles(&m.facade.name, &m.facade)
                .caption(format!("{} terminals", m.facade.regions.len())),
        );
    }
    ctx.figure("figure_10", &figure)
}
