//! City grammars as CGA of CityEngine: rules, start shapes and assets.
//!
//! `CITY.cga` has a rule for each type of building, with an `attr` for each of its parameters and three factors, of the width, the
//! depth and the height of all that the rule puts down. `CITY.shapes.geojson` has a polygon for each building: its footprint with the
//! height of its base, the rule that it starts with, and each attribute whose value is not the text's own. The folder
//! `CITY.assets` has a mesh for each template that is no box.
//!
//! ```text
//! @Group("B1") attr B1_width = 12
//! @Group("B1") attr B1_depth = 9
//! @Group("B1") attr B1_h1 = 6
//! @Group("B1") attr B1_h2 = 3.5
//! @Group("B1") attr B1_height_factor = 1
//!
//! @StartRule
//! B1 -->
//!     alignScopeToGeometry(yUp, 0, 0) t(scope.sx / 2, 0, scope.sz / 2)
//!     [ s(span(B1_width) * B1_width_factor, span(B1_h1) * B1_height_factor, span(B1_depth) * B1_depth_factor) T1 ]
//!     [ t(0, cm(B1_h1) * B1_height_factor, 0) r(0, 90, 0) s(...) T2 ]
//!
//! T1 --> t(-0.5 * scope.sx, 0, -0.5 * scope.sz) primitiveCube()
//! T2 --> t(-0.5 * scope.sx, 0, -0.5 * scope.sz) i("CITY.assets/T2.obj")
//! ```
//!
//! # What CityEngine asks for
//! The pages of its reference are listed in [`edifice_io::grammar_cga::solids`], the independent reader, which evaluates the text
//! as [`read`] does. Beyond them:
//! - An attribute is set for a shape by an object attribute of the same name ([attributes]); the property `rule` names the start rule.
//! - A footprint begins with the corner of smallest x and y in the building's own frame, counterclockwise. Rules begin by laying x along
//!   the first edge (`op_alignScopeToGeometry.html`) and by a step to the middle of the scope: other attributes leave a building's middle
//!   where it is.
//! - An asset's bounding box becomes the scope (`op_i.html`), whatever its own size; assets are y up, a unit box is 100 units wide. They are
//!   sought in the folder `assets` of the project, and in the project itself ([asset search]).
//! - CityEngine reads feature classes and shapefiles, not GeoJSON; [JSON To Features] makes one of the other.
//!
//! # What is left out
//! Residuals: parts stand where the rules put them, as in [`InstanceGrammar::rules_only`]. Pictures, attributes of buildings, the weights of
//! rules, and rules that the axiom does not lead to. A rule without parameters is no type: each thing that it puts down is a shape, that
//! of a template `T` with the rule `T_building`.
//!
//! [attributes]: https://doc.arcgis.com/en/cityengine/latest/help/help-rules-attributes.htm
//! [asset search]: https://doc.arcgis.com/en/cityengine/latest/cga/cga-asset-texture-search.htm
//! [JSON To Features]: https://pro.arcgis.com/en/pro-app/latest/tool-reference/conversion/json-to-features.htm

mod assets;
mod error;
mod features;
mod read;
mod rules;
mod shapes;

use std::path::Path;

pub use error::CgaCityError;
pub use read::read;

use edifice_base::{Error, Result};
use edifice_grammar::instance::InstanceGrammar;
use edifice_io::{file_stem, write_atomic};
use rules::Rules;

/// A city grammar in CGA.
#[derive(Debug, Clone, PartialEq)]
pub struct CgaCity {
    /// The rules: text of CGA.
    pub rules: String,
    /// The start shapes: text of GeoJSON, in metres, in the coordinates of the reference system.
    pub shapes: String,
    /// Name and text, Wavefront OBJ with y up, of each asset.
    pub assets: Vec<(String, String)>,
    /// Number of start shapes.
    pub buildings: usize,
}

/// Tells a grammar in CGA; `folder` is the path of the assets' folder as the rules name it.
///
/// # Errors
/// [`CgaCityError`].
pub fn export(
    grammar: &InstanceGrammar,
    folder: &str,
) -> std::result::Result<CgaCity, CgaCityError> {
    grammar.check()?;
    let starts = shapes::starts(grammar)?;
    let rules = Rules::new(grammar, &starts);
    let mut assets = Vec::new();
    let text = rules.text(folder, &mut assets)?;
    Ok(CgaCity {
        rules: text,
        shapes: features::text(grammar, &starts, &rules),
        assets,
        buildings: starts.len(),
    })
}

/// Writes a grammar as `path`, with its start shapes and assets beside it; each file whole or not at all, `path` the last.
///
/// # Errors
/// [`Error::Content`] with [`CgaCityError`], and [`Error::Io`] when a file cannot be written.
pub fn write(grammar: &InstanceGrammar, path: &Path) -> Result<()> {
    let folder = path.with_extension("assets");
    let named = format!("{}.assets", file_stem(path));
    let city = export(grammar, &named).map_err(|e| Error::content(path, e))?;
    if !city.assets.is_empty() {
        std::fs::create_dir_all(&folder).map_err(|e| Error::io(&folder, "create", e))?;
    }
    for (name, text) in &city.assets {
        write_atomic(&folder.join(name), text.as_bytes())?;
    }
    write_atomic(&shapes_path(path), city.shapes.as_bytes())?;
    write_atomic(path, city.rules.as_bytes())
}

/// The file of the start shapes beside a file of rules.
fn shapes_path(path: &Path) -> std::path::PathBuf {
    path.with_extension("shapes.geojson")
}
