//! Learning the model of a table by default settings, from the table as its schema reads it to a [`TableModel`].

use super::Dataset;
use super::encoding::Encoding;
use super::joined::{Joined, learn_joined};
use super::schema::Schema;
use super::table_model::TableModel;
use crate::ModelError;
use crate::hierarchy::{Observer, Settings, Variant};

/// The settings of the extended model: lateral edges, from categories as well.
pub fn extended(settings: &Settings) -> Settings {
    Settings {
        variant: Variant::Full,
        category_edges: true,
        ..settings.clone()
    }
}

/// The encoding of a table's numbers, learnt from it, and the table in it. `observer` is asked before each column: those that come after it has
/// ended enter without a transform.
///
/// # Errors
/// As [`Encoding::learn`] and [`Encoding::encode`].
pub(super) fn encode(
    data: &Dataset,
    settings: &Settings,
    seed: u64,
    observer: &Observer,
) -> Result<(Encoding, Dataset), ModelError> {
    let goes_on = || observer(None).is_continue();
    let (encoding, _) = Encoding::learn_while(data, &settings.priors.linear, seed, &goes_on)?;
    let table = encoding.encode(&data.table)?;
    let groups = encoding.groups(&data.groups);
    Ok((encoding, Dataset { table, groups }))
}

/// Learns the extended model of a table, and the encoding by which it reads numbers; [`TableModel::learn`] keeps both with the schema.
///
/// # Errors
/// As [`TableModel::learn`].
pub(super) fn learn_encoded(
    data: &Dataset,
    settings: &Settings,
    seed: u64,
    observer: &Observer,
) -> Result<(Encoding, Joined), ModelError> {
    let (encoding, encoded) = encode(data, settings, seed, observer)?;
    let (table, groups) = (&encoded.table, &encoded.groups);
    let search = learn_joined(table, groups, &extended(settings), seed, observer)?;
    Ok((encoding, search))
}

/// A learned model of a table, and the search that found it.
#[derive(Debug, Clone)]
pub struct LearnedTable {
    /// The model.
    pub model: TableModel,
    /// The search on the encoded table; `search.learned.interrupted` says whether the observer ended it.
    pub search: Joined,
}

impl TableModel {
    /// Learns the extended model of a table: numbers enter by an [`Encoding`] learnt first, categories may depend on each
    /// other, and the real columns share hidden variables, all or in groups, where that scores higher ([`learn_joined`]).
    ///
    /// Columns that others determine ([`super::relations`]) are left out and computed again in draws.
    ///
    /// `data` are the rows as `schema` reads them, of n rows; `settings` are those of the published model, of which variant and
    /// edges of categories are set here. The same seed gives the same model for any number of threads. The search, which
    /// `observer` may end, costs O(n) a step; an ended search gives the best model so far.
    ///
    /// # Errors
    /// As [`Encoding::learn`], [`Relations::reduce`](super::relations::Relations::reduce) and [`learn`](crate::hierarchy::learn): a table without rows or columns, or settings out of range.
    ///
    /// # Examples
    /// ```
    /// use std::ops::ControlFlow;
    /// use edifice_model::hierarchy::Settings;
    /// use edifice_model::tables::schema::Schema;
    /// use edifice_model::tables::table_model::TableModel;
    /// let header = ["width".to_owned(), "roof".to_owned()];
    /// let row = |i: usize| match i % 2 {
    ///     0 => vec![format!("{}", 8.0 + 0.01 * (i % 7) as f64), "gable".to_owned()],
    ///     _ => vec![format!("{}", 14.0 + 0.01 * (i % 5) as f64), "hip".to_owned()],
    /// };
    /// let rows: Vec<Vec<String>> = (0..60).map(row).collect();
    /// let schema = Schema::guess(&header, &rows)?;
    /// let data = schema.read(&header, &rows)?;
    /// let settings = Settings { styles: 1..=3, ..Settings::default() };
    /// let found = TableModel::learn(&data, &schema, &settings, 1, &|_| ControlFlow::Continue(()))?;
    /// let logs = found.model.log_likelihood(&data.table)?;
    /// assert!(logs.iter().all(|log| log.is_finite()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn learn(
        data: &Dataset,
        schema: &Schema,
        settings: &Settings,
        seed: u64,
        observer: &Observer,
    ) -> Result<LearnedTable, ModelError> {
        let schema = schema.clone().related(data);
        let data = schema.relations()?.reduce_dataset(data)?;
        let (encoding, search) = learn_encoded(&data, settings, seed, observer)?;
        Ok(LearnedTable {
            model: Self {
                schema,
                encoding: Some(encoding),
                model: search.learned.model.clone(),
            },
            search,
        })
    }
}
