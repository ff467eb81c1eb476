//! Plain values to files: tidy CSV, Markdown, SVG and PNG figures, the HTML index. Knows no method.
//!
//! - [`Row`] and [`write_rows`]: observations, one a line.
//! - [`Table`]: a Markdown table.
//! - [`Figure`]: panels in a grid ([`Chart`], [`Bars`], [`HeatMap`], [`Dendrogram`], [`Tiles`], [`Ranking`]), drawn once as a list of
//!   marks and rendered by plotters to SVG and to PNG (256 colours) at twice the resolution, with the font that the `dejavu` crate ships.
//! - [`index`]: one page over everything.
//!
//! Every file appears whole or not at all ([`edifice_base::file::write_atomic`]).

mod axis;
mod bars;
mod beside;
mod chart;
mod colour;
mod dendrogram;
mod drawing;
mod figure;
mod frame;
mod heat_map;
mod html;
mod indexed;
mod markdown;
mod ranking;
mod render;
mod rows;
mod table;
mod tiles;

pub use axis::Scale;
pub use bars::{BarGroup, Bars};
pub use beside::{Beside, Counts};
pub use chart::{Chart, Series};
pub use colour::{Colour, category, ramp};
pub use dendrogram::{Dendrogram, Merge};
pub use figure::{Figure, MOST_SVG_BYTES, Panel, write_figure, write_report_figure};
pub use frame::Corner;
pub use heat_map::HeatMap;
pub use html::{Page, Section, index};
pub use indexed::few_colours;
pub use ranking::Ranking;
pub use rows::{Row, csv_bytes, write_rows};
pub use table::{Align, Table};
pub use tiles::{Outline, Tile, Tiles};
