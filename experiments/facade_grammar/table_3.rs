//! Table 3: scores that people gave. It needs people: only the printed row is shown.

use super::published::{AUTOMATIC, Published};
use edifice_base::Result;
use edifice_frame::Context;
use edifice_report::{Align, Table};

/// Shows the printed numbers.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let printed = Published::read(ctx)?;
    let users = (1..=7).map(|u| format!("user_{u}"));
    let methods: Vec<String> = AUTOMATIC
        .map(String::from)
        .into_iter()
        .chain(users)
        .collect();
    let mut table = Table::new("Printed in the paper")
        .column("", Align::Left)
        .numbers(methods.iter().map(String::as_str));
    for metric in [
        "score",
        "expert_share",
        "cost",
        "rank_by_users",
        "rank_by_cost",
    ] {
        let values = methods
            .iter()
            .map(|m| printed.text(["table_3", m, "five facades", metric, "value"]));
        table.row(std::iter::once(metric.to_string()).chain(values));
    }
    ctx.table(&table);
    ctx.skip("seven experts scored grammars of five facades: this needs people");
    Ok(())
}
