//! Instance grammars: symbols with transforms (Demir et al. 2014, Eq. 5 to 7).
//!
//! A terminal is a template: a mesh in the unit box (x and y from -1/2 to 1/2, z from 0 to 1). A rule
//! `N → ⊕ E_l N_l` puts its successors, each by a transform E_l, into the frame of N. The axiom's
//! derivation is the city.
//!
//! A placed non-terminal may carry `parts`: where each successor of its rule stands in this instance, or
//! that it is absent. Without them the successors stand where the rule, with its mean transforms, puts
//! them.

use rustc_hash::FxHashMap;

use crate::shape::solid::TriangleMesh;

/// Deepest nesting of rules.
const DEEPEST: usize = 64;
/// Most placed templates that a derivation may have.
pub const INSTANCE_LIMIT: usize = 20_000_000;

/// A symbol in its place: scaled, turned about the vertical, shifted.
#[derive(Debug, Clone, PartialEq)]
pub struct Placement {
    /// Template or non-terminal.
    pub symbol: String,
    /// Shift, in metres, in the frame of the rule's symbol.
    pub at: [f64; 3],
    /// Turn about the vertical in degrees, counterclockwise seen from above.
    pub turn: f64,
    /// Of a template: its width, depth and height in metres. Of a non-terminal: one factor, three times.
    pub size: [f64; 3],
    /// Identifier of the building that this is, or is a part of.
    pub id: Option<String>,
    /// Further properties of that building.
    pub attributes: serde_json::Map<String, serde_json::Value>,
    /// Where this instance's successors stand, in the order of the rule; `None` is absent. Empty: where
    /// the rule says.
    pub parts: Vec<Option<Placement>>,
}

impl Placement {
    /// A symbol at a place.
    pub fn new(symbol: impl Into<String>, at: [f64; 3], turn: f64, size: [f64; 3]) -> Self {
        Self {
            symbol: symbol.into(),
            at,
            turn,
            size,
            id: None,
            attributes: serde_json::Map::new(),
            parts: Vec::new(),
        }
    }
}

/// A terminal: a mesh in the unit box.
#[derive(Debug, Clone, PartialEq)]
pub struct Template {
    /// Symbol.
    pub symbol: String,
    /// The mesh.
    pub mesh: TriangleMesh,
}

/// One way to replace a non-terminal.
#[derive(Debug, Clone, PartialEq)]
pub struct InstanceRule {
    /// The non-terminal.
    pub symbol: String,
    /// How often, against the other rules of the symbol.
    pub weight: f64,
    /// What replaces it.
    pub successors: Vec<Placement>,
}

/// A city as rules over templates.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct InstanceGrammar {
    /// Name.
    pub name: String,
    /// Coordinate reference system.
    pub reference_system: Option<String>,
    /// What to add to every coordinate to be in the reference system.
    pub origin: [f64; 3],
    /// Start symbol.
    pub axiom: String,
    /// Terminals.
    pub templates: Vec<Template>,
    /// Rules; of several with one symbol, a derivation takes the first, sampling draws by weight.
    pub rules: Vec<InstanceRule>,
}

/// Why a grammar cannot be derived.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InstanceGrammarError {
    /// A symbol is neither template nor non-terminal.
    #[error("rules[{rule}].successors[{successor}]: unknown symbol {symbol:?}")]
    UnknownSymbol {
        /// Index of the rule.
        rule: usize,
        /// Index of the successor.
        successor: usize,
        /// The symbol.
        symbol: String,
    },
    /// A symbol names two things.
    #[error("{0:?} names two templates, or a template and a non-terminal")]
    Ambiguous(String),
    /// The axiom has no rule.
    #[error("the axiom {0:?} has no rule")]
    NoAxiom(String),
    /// A non-terminal contains itself.
    #[error("{0:?} contains itself")]
    Cyclic(String),
    /// Rules nest too deeply.
    #[error("rules nest more than {DEEPEST} deep at {0:?}")]
    TooDeep(String),
    /// A number is not usable.
    #[error("{place}: {value} is not a usable {what}")]
    Number {
        /// Where.
        place: String,
        /// What it is.
        what: &'static str,
        /// The value.
        value: f64,
    },
    /// A template's triangle names a position that it does not have.
    #[error("templates[{template}].triangles: index {index} of {count} positions")]
    Dangling {
        /// Index of the template.
        template: usize,
        /// The index.
        index: u32,
        /// How many positions there are.
        count: usize,
    },
    /// Parts do not follow the rule.
    #[error("an instance of {symbol:?} has {found} parts where its rule has {expected}")]
    Parts {
        /// The non-terminal.
        symbol: String,
        /// Parts given.
        found: usize,
        /// Successors of its rule.
        expected: usize,
    },
    /// A derivation is too large.
    #[error("the derivation has more than {INSTANCE_LIMIT} instances")]
    TooLarge,
}

/// A template in its final place.
#[derive(Debug, Clone, PartialEq)]
pub struct TemplateInstance {
    /// Index of the template.
    pub template: usize,
    /// Index of the building, if any.
    pub building: Option<usize>,
    /// Middle of the base.
    pub at: [f64; 3],
    /// Turn about the vertical in degrees.
    pub turn: f64,
    /// Width, depth and height.
    pub size: [f64; 3],
}

impl TemplateInstance {
    /// Where a point of the template goes.
    pub fn place(&self, p: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = [0, 1, 2].map(|i| p[i] * self.size[i]);
        let (sin, cos) = self.turn.to_radians().sin_cos();
        let [a, b, c] = self.at;
        [a + x * cos - y * sin, b + x * sin + y * cos, c + z]
    }
}

/// Everything that a grammar's axiom derives to.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct InstanceDerivation {
    /// Identifier and properties of each building.
    pub buildings: Vec<(String, serde_json::Map<String, serde_json::Value>)>,
    /// Templates in place.
    pub instances: Vec<TemplateInstance>,
    /// Greatest number of rules applied one inside another.
    pub depth: usize,
    index: FxHashMap<String, usize>,
}

impl InstanceGrammar {
    /// Replaces non-terminals from the axiom until only templates are left.
    ///
    /// # Errors
    /// [`InstanceGrammarError`]; the grammar is checked whole first.
    pub fn derive(&self) -> Result<InstanceDerivation, InstanceGrammarError> {
        let symbols = self.symbols()?;
        let Some(&Symbol::Rule(start)) = symbols.get(self.axiom.as_str()) else {
            return Err(InstanceGrammarError::NoAxiom(self.axiom.clone()));
        };
        let mut out = InstanceDerivation::default();
        let frame = Frame {
            at: [0.0; 3],
            turn: 0.0,
            scale: 1.0,
        };
        let derivation = Deriver {
            grammar: self,
            symbols: &symbols,
        };
        derivation.rule(start, &[], &frame, None, 1, &mut out)?;
        Ok(out)
    }

    /// Number of symbols with rules.
    pub fn non_terminals(&self) -> usize {
        let mut symbols: Vec<&str> = self.rules.iter().map(|r| r.symbol.as_str()).collect();
        symbols.sort_unstable();
        symbols.dedup();
        symbols.len()
    }

    /// Checks numbers, references and nesting.
    ///
    /// # Errors
    /// [`InstanceGrammarError`].
    pub fn check(&self) -> Result<(), InstanceGrammarError> {
        let symbols = self.symbols()?;
        match symbols.get(self.axiom.as_str()) {
            Some(Symbol::Rule(_)) => Ok(()),
            _ => Err(InstanceGrammarError::NoAxiom(self.axiom.clone())),
        }
    }

    /// Names every symbol, and checks numbers, references and nesting.
    fn symbols(&self) -> Result<FxHashMap<&str, Symbol>, InstanceGrammarError> {
        let mut symbols = FxHashMap::default();
        for (i, template) in self.templates.iter().enumerate() {
            if symbols
                .insert(template.symbol.as_str(), Symbol::Template(i))
                .is_some()
            {
                return Err(InstanceGrammarError::Ambiguous(template.symbol.clone()));
            }
            let count = template.mesh.positions.len();
            let mut indices = template.mesh.triangles.iter().flatten();
            if let Some(&index) = indices.find(|&&i| i as usize >= count) {
                let template = i;
                return Err(InstanceGrammarError::Dangling {
                    template,
                    index,
                    count,
                });
            }
            let place = || format!("templates[{i}].positions");
            let mut values = template.mesh.positions.iter().flatten();
            values.try_for_each(|&v| number(v, "coordinate", v.is_finite(), place))?;
        }
        for (i, rule) in self.rules.iter().enumerate() {
            match symbols.get(rule.symbol.as_str()) {
                Some(Symbol::Template(_)) => {
                    return Err(InstanceGrammarError::Ambiguous(rule.symbol.clone()));
                }
                Some(Symbol::Rule(_)) => {}
                None => {
                    symbols.insert(rule.symbol.as_str(), Symbol::Rule(i));
                }
            }
            let usable = rule.weight.is_finite() && rule.weight >= 0.0;
            number(rule.weight, "weight", usable, || {
                format!("rules[{i}].weight")
            })?;
        }
        for (rule, r) in self.rules.iter().enumerate() {
            for (successor, s) in r.successors.iter().enumerate() {
                if !symbols.contains_key(s.symbol.as_str()) {
                    let symbol = s.symbol.clone();
                    return Err(InstanceGrammarError::UnknownSymbol {
                        rule,
                        successor,
                        symbol,
                    });
                }
                let place = || format!("rules[{rule}].successors[{successor}]");
                check_placement(s, &symbols, &place)?;
            }
        }
        self.check_cycles(&symbols)?;
        Ok(symbols)
    }

    /// Depth-first search over the rules; an open rule met again is a cycle.
    fn check_cycles(&self, symbols: &FxHashMap<&str, Symbol>) -> Result<(), InstanceGrammarError> {
        let mut by_symbol: FxHashMap<&str, Vec<usize>> = FxHashMap::default();
        for (i, rule) in self.rules.iter().enumerate() {
            by_symbol.entry(rule.symbol.as_str()).or_default().push(i);
        }
        let mut state: FxHashMap<&str, bool> = FxHashMap::default();
        for rule in &self.rules {
            let mut stack = vec![(rule.symbol.as_str(), true)];
            while let Some((symbol, enter)) = stack.pop() {
                if !enter {
                    state.insert(symbol, true);
                    continue;
                }
                match state.get(symbol) {
                    Some(true) => continue,
                    Some(false) => return Err(InstanceGrammarError::Cyclic(symbol.to_owned())),
                    None => {}
                }
                state.insert(symbol, false);
                stack.push((symbol, false));
                if stack.iter().filter(|s| !s.1).count() > DEEPEST {
                    return Err(InstanceGrammarError::TooDeep(symbol.to_owned()));
                }
                let mut inner: Vec<&str> = by_symbol
                    .get(symbol)
                    .into_iter()
                    .flatten()
                    .flat_map(|&i| &self.rules[i].successors)
                    .map(|s| s.symbol.as_str())
                    .filter(|s| matches!(symbols.get(s), Some(Symbol::Rule(_))))
                    .collect();
                inner.sort_unstable();
                inner.dedup();
                stack.extend(inner.into_iter().map(|s| (s, true)));
            }
        }
        Ok(())
    }
}

#[derive(Debug, Clone, Copy)]
enum Symbol {
    Template(usize),
    Rule(usize),
}

fn number(
    value: f64,
    what: &'static str,
    usable: bool,
    place: impl Fn() -> String,
) -> Result<(), InstanceGrammarError> {
    match usable {
        true => Ok(()),
        false => Err(InstanceGrammarError::Number {
            place: place(),
            what,
            value,
        }),
    }
}

fn check_placement(
    placement: &Placement,
    symbols: &FxHashMap<&str, Symbol>,
    place: &dyn Fn() -> String,
) -> Result<(), InstanceGrammarError> {
    for v in placement.at {
        number(v, "shift", v.is_finite(), || format!("{}.at", place()))?;
    }
    let turn = placement.turn;
    number(turn, "turn", turn.is_finite(), || {
        format!("{}.turn", place())
    })?;
    let [w, d, h] = placement.size;
    for v in [w, d, h] {
        let usable = v.is_finite() && v > 0.0;
        number(v, "size", usable, || format!("{}.size", place()))?;
    }
    if let Some(Symbol::Rule(_)) = symbols.get(placement.symbol.as_str()) {
        let what = "size of a non-terminal, which takes one factor for all axes";
        number(d, what, w == d && d == h, || format!("{}.size", place()))?;
    }
    let mut parts = placement.parts.iter().flatten();
    parts.try_for_each(|part| check_placement(part, symbols, place))
}

/// The frame of a non-terminal.
struct Frame {
    at: [f64; 3],
    turn: f64,
    scale: f64,
}

struct Deriver<'a> {
    grammar: &'a InstanceGrammar,
    symbols: &'a FxHashMap<&'a str, Symbol>,
}

impl Deriver<'_> {
    fn rule(
        &self,
        rule: usize,
        parts: &[Option<Placement>],
        frame: &Frame,
        building: Option<usize>,
        depth: usize,
        out: &mut InstanceDerivation,
    ) -> Result<(), InstanceGrammarError> {
        let rule = &self.grammar.rules[rule];
        out.depth = out.depth.max(depth);
        if !parts.is_empty() && parts.len() != rule.successors.len() {
            return Err(InstanceGrammarError::Parts {
                symbol: rule.symbol.clone(),
                found: parts.len(),
                expected: rule.successors.len(),
            });
        }
        for (i, successor) in rule.successors.iter().enumerate() {
            let placed = match parts.get(i) {
                None => successor,
                Some(None) => continue,
                Some(Some(part)) => part,
            };
            self.place(placed, &successor.symbol, frame, building, depth, out)?;
        }
        Ok(())
    }

    fn place(
        &self,
        placed: &Placement,
        symbol: &str,
        frame: &Frame,
        building: Option<usize>,
        depth: usize,
        out: &mut InstanceDerivation,
    ) -> Result<(), InstanceGrammarError> {
        let (sin, cos) = frame.turn.to_radians().sin_cos();
        let [x, y, z] = placed.at.map(|v| v * frame.scale);
        let at = [
            frame.at[0] + x * cos - y * sin,
            frame.at[1] + x * sin + y * cos,
            frame.at[2] + z,
        ];
        let turn = frame.turn + placed.turn;
        let building = match &placed.id {
            Some(id) => Some(out.building(id, &placed.attributes)),
            None => building,
        };
        match self.symbols.get(symbol) {
            Some(&Symbol::Template(template)) => {
                if out.instances.len() >= INSTANCE_LIMIT {
                    return Err(InstanceGrammarError::TooLarge);
                }
                out.instances.push(TemplateInstance {
                    template,
                    building,
                    at,
                    turn,
                    size: placed.size.map(|v| v * frame.scale),
                });
                Ok(())
            }
            Some(&Symbol::Rule(rule)) => {
                let frame = Frame {
                    at,
                    turn,
                    scale: frame.scale * placed.size[0],
                };
                self.rule(rule, &placed.parts, &frame, building, depth + 1, out)
            }
            None => Err(InstanceGrammarError::NoAxiom(symbol.to_owned())),
        }
    }
}

impl InstanceDerivation {
    /// The index of a building, which is new at its first placement.
    fn building(
        &mut self,
        id: &str,
        attributes: &serde_json::Map<String, serde_json::Value>,
    ) -> usize {
        if let Some(&known) = self.index.get(id) {
            return known;
        }
        self.buildings.push((id.to_owned(), attributes.clone()));
        self.index.insert(id.to_owned(), self.buildings.len() - 1);
        self.buildings.len() - 1
    }

    /// The triangles of each building; instances outside all buildings are buildings of their own.
    pub fn city(&self, grammar: &InstanceGrammar) -> crate::shape::solid::City {
        use crate::shape::solid::{City, CityBuilding};
        let named = self.buildings.iter().map(|(id, attributes)| CityBuilding {
            id: id.clone(),
            attributes: attributes.clone(),
            mesh: TriangleMesh::default(),
        });
        let mut buildings: Vec<CityBuilding> = named.collect();
        for (i, instance) in self.instances.iter().enumerate() {
            let building = instance.building.unwrap_or_else(|| {
                buildings.push(CityBuilding {
                    id: format!("instance-{i}"),
                    ..CityBuilding::default()
                });
                buildings.len() - 1
            });
            let template = &grammar.templates[instance.template].mesh;
            let positions = template.positions.iter().map(|&p| instance.place(p));
            buildings[building].mesh.append(&TriangleMesh {
                positions: positions.collect(),
                triangles: template.triangles.clone(),
            });
        }
        City {
            name: grammar.name.clone(),
            reference_system: grammar.reference_system.clone(),
            origin: grammar.origin,
            buildings,
        }
    }
}
