//! CGA rules that make solids: boxes and assets, moved, turned and sized.
//!
//! The part of CityEngine's reference that `edifice_io_city::cga` writes is read here, from the text alone, and evaluated for one start
//! shape after another. Coordinates are CityEngine's: x and z lie in the plane, y is up, and the three are right-handed.
//! Pages are below <https://esri.github.io/cityengine-sdk/html/cgaref/cgareference/> unless said otherwise.
//!
//! | page | read as |
//! | --- | --- |
//! | `attr.html`, `const.html` | a number for each name, evaluated in the order of the text; the start shape may state another for an `attr` |
//! | [functions], [conditions] | `name(a, b) = ...`, also of two cases, `case x < y : ... else : ...`; `floor`, `sqrt` and `rint` are known |
//! | [standard rule] | operations and symbols, one after another; a symbol is a shape with the scope that there is then |
//! | `op_alignScopeToGeometry.html` | `alignScopeToGeometry(yUp, 0, 0)`: the scope of a start shape, which lies so already |
//! | `op_t.html` | moves the scope along its own axes |
//! | `op_r.html` | turns the scope about its origin, in degrees; only about y |
//! | `op_s.html` | sets the sizes of the scope |
//! | `op_pop_push.html` | `[ ... ]`: behind it the scope is what it was before |
//! | `attr_scope.html` | `scope.sx`, `scope.sy`, `scope.sz` |
//! | `op_i.html` | an asset whose bounding box is the scope; the path in quotes is all that it may state |
//! | `op_primitive.html` | `primitiveCube()`: a box that is the scope |
//! | `op_nil.html` | `NIL`: nothing |
//! | `version.html`, `cga_annotations.html` | skipped |
//!
//! Everything else is an error with line and column.
//!
//! [functions]: https://doc.arcgis.com/en/cityengine/latest/help/help-rules-functions.htm
//! [conditions]: https://doc.arcgis.com/en/cityengine/latest/help/help-conditional-rule.htm
//! [standard rule]: http://cehelp.esri.com/help/topic/com.procedural.cityengine.help/html/manual/cga/writing_rules/cga_wr_standard_rule.html

mod evaluate;
mod parse;
mod syntax;

use std::collections::BTreeMap;

use super::error::CgaError;
use syntax::Program;

/// A box in space with axes of its own: the place of a shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scope {
    /// The corner of smallest x, y and z along its own axes, in metres, y up.
    pub at: [f64; 3],
    /// Turn about y in degrees, counterclockwise seen from above.
    pub turn: f64,
    /// Extent along its own axes in metres.
    pub size: [f64; 3],
}

impl Scope {
    /// A point given along the axes of the scope, from its corner, in metres.
    pub fn point(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let (sin, cos) = self.turn.to_radians().sin_cos();
        let [a, b, c] = self.at;
        [a + x * cos + z * sin, b + y, c - x * sin + z * cos]
    }
}

/// Something solid that rules put down.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// The path of the asset as the text states it; `None` is a box.
    pub asset: Option<String>,
    /// The bounding box of what is put down, along its own axes.
    pub scope: Scope,
}

/// The rules of a text.
#[derive(Debug, Clone)]
pub struct SolidRules<'a> {
    text: &'a str,
    program: Program<'a>,
}

impl<'a> SolidRules<'a> {
    /// Reads rules from text.
    ///
    /// # Errors
    /// [`CgaError`] at what is no CGA, or is not read here.
    pub fn parse(text: &'a str) -> Result<Self, CgaError> {
        match parse::program(text) {
            Ok(program) => Ok(Self { text, program }),
            Err(fault) => Err(CgaError::new(fault, text)),
        }
    }

    /// Everything that the rule `start` puts into a scope; `attributes` are what the start shape states in place of the
    /// text's own values.
    ///
    /// # Errors
    /// [`CgaError`] at names that are not there, numbers that are not finite, scopes without extent where something is put down,
    /// and rules that never end.
    pub fn evaluate(
        &self,
        start: &str,
        attributes: &BTreeMap<String, f64>,
        scope: Scope,
    ) -> Result<Vec<Solid>, CgaError> {
        evaluate::evaluate(&self.program, start, attributes, scope)
            .map_err(|fault| CgaError::new(fault, self.text))
    }

    /// True if the text has a rule of this name.
    pub fn has_rule(&self, name: &str) -> bool {
        self.program.rules.contains_key(name)
    }
}
