//! From the axiom to placed templates, and to triangles.

use rustc_hash::FxHashMap;

use super::check::Symbol;
use super::limits::INSTANCE_LIMIT;
use super::{InstanceGrammar, InstanceGrammarError, Placement, Places};
use edifice_shape::triangles::TriangleMesh;

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
    /// The place of a point of the template.
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
    /// The first instance of each building without an identifier, in order: one of a rule with parameters, or a template that
    /// stands in no building. It goes on to the next one; instances of `buildings` are not of it.
    pub unnamed: Vec<usize>,
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
        let derivation = Deriver {
            places: Places::new(self),
            symbols: &symbols,
        };
        let axiom = Placement::new(self.axiom.as_str(), [0.0; 3], 0.0, [1.0; 3]);
        let outside = Place {
            building: None,
            inside: false,
            depth: 1,
        };
        derivation.rule(start, &axiom, &Frame::WORLD, outside, &mut out)?;
        Ok(out)
    }
}

/// The frame of a non-terminal.
pub(super) struct Frame {
    pub(super) at: [f64; 3],
    pub(super) turn: f64,
    pub(super) scale: f64,
}

impl Frame {
    /// The frame of the axiom.
    pub(super) const WORLD: Self = Self {
        at: [0.0; 3],
        turn: 0.0,
        scale: 1.0,
    };

    /// The place of a successor, and its turn.
    pub(super) fn place(&self, placed: &Placement) -> ([f64; 3], f64) {
        let (sin, cos) = self.turn.to_radians().sin_cos();
        let [x, y, z] = placed.at.map(|v| v * self.scale);
        let [a, b, c] = self.at;
        let at = [a + x * cos - y * sin, b + x * sin + y * cos, c + z];
        (at, self.turn + placed.turn)
    }
}

/// A place in a derivation.
#[derive(Clone, Copy)]
struct Place {
    /// The building with an identifier that it is in.
    building: Option<usize>,
    /// True in a building without an identifier.
    inside: bool,
    /// Rules applied one inside another.
    depth: usize,
}

struct Deriver<'a> {
    places: Places<'a>,
    symbols: &'a FxHashMap<&'a str, Symbol>,
}

impl Deriver<'_> {
    fn rule(
        &self,
        rule: usize,
        own: &Placement,
        frame: &Frame,
        place: Place,
        out: &mut InstanceDerivation,
    ) -> Result<(), InstanceGrammarError> {
        out.depth = out.depth.max(place.depth);
        for placed in self.places.of(rule, own).iter().flatten() {
            self.place(placed, frame, place, out)?;
        }
        Ok(())
    }

    fn place(
        &self,
        placed: &Placement,
        frame: &Frame,
        Place {
            building,
            inside,
            depth,
        }: Place,
        out: &mut InstanceDerivation,
    ) -> Result<(), InstanceGrammarError> {
        let (at, turn) = frame.place(placed);
        let building = match &placed.id {
            Some(id) => Some(out.building(id, &placed.attributes)),
            None => building,
        };
        match self.symbols.get(placed.symbol.as_str()) {
            Some(&Symbol::Template(template)) => {
                if out.instances.len() >= INSTANCE_LIMIT {
                    return Err(InstanceGrammarError::TooLarge);
                }
                if building.is_none() && !inside {
                    out.unnamed.push(out.instances.len());
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
                let begins = building.is_none() && !inside && self.places.is_type(rule);
                let first = out.instances.len();
                let inner = Place {
                    building,
                    inside: inside || begins,
                    depth: depth + 1,
                };
                self.rule(rule, placed, &frame, inner, out)?;
                let own = &out.instances[first..];
                if begins && own.iter().any(|i| i.building.is_none()) {
                    out.unnamed.push(first);
                }
                Ok(())
            }
            None => Err(InstanceGrammarError::UnknownPart(placed.symbol.clone())),
        }
    }
}

impl InstanceDerivation {
    /// Number of buildings, those without an identifier among them.
    pub fn count(&self) -> usize {
        self.buildings.len() + self.unnamed.len()
    }

    /// The first instance of the building without an identifier that an instance is of.
    fn first(&self, instance: usize) -> usize {
        let after = self.unnamed.partition_point(|&first| first <= instance);
        let before = after.checked_sub(1).and_then(|k| self.unnamed.get(k));
        before.map_or(instance, |&first| first)
    }

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

    /// Some of the instances, shifted by `-origin`, with their buildings.
    pub fn part(&self, members: &[usize], origin: [f64; 3]) -> Self {
        let mut out = Self {
            depth: self.depth,
            ..Self::default()
        };
        let mut last = None;
        for &i in members {
            if self.instances[i].building.is_none() && last != Some(self.first(i)) {
                last = Some(self.first(i));
                out.unnamed.push(out.instances.len());
            }
            let mut instance = self.instances[i].clone();
            instance.at = [0, 1, 2].map(|k| instance.at[k] - origin[k]);
            let building = instance.building.map(|b| &self.buildings[b]);
            instance.building = building.map(|(id, attributes)| out.building(id, attributes));
            out.instances.push(instance);
        }
        out
    }

    /// The triangles of each building; one without an identifier is named after its first instance, `instance-N`.
    pub fn city(&self, grammar: &InstanceGrammar) -> edifice_shape::triangles::City {
        use edifice_shape::triangles::{City, CityBuilding, OrientedBox};
        let named = self.buildings.iter().map(|(id, attributes)| CityBuilding {
            id: id.clone(),
            attributes: attributes.clone(),
            ..CityBuilding::default()
        });
        let mut buildings: Vec<CityBuilding> = named.collect();
        let mut last = None;
        for (i, instance) in self.instances.iter().enumerate() {
            let building = instance.building.unwrap_or_else(|| {
                let first = self.first(i);
                if last != Some(first) {
                    last = Some(first);
                    buildings.push(CityBuilding {
                        id: format!("instance-{first}"),
                        ..CityBuilding::default()
                    });
                }
                buildings.len() - 1
            });
            let template = &grammar.templates[instance.template];
            let positions = template.mesh.positions.iter().map(|&p| instance.place(p));
            let placed = TriangleMesh {
                positions: positions.collect(),
                triangles: template.mesh.triangles.clone(),
            };
            let frame = OrientedBox {
                base: instance.at,
                size: instance.size,
                angle: instance.turn.to_radians(),
            };
            let frame = Some(frame).filter(|f| f.size.iter().all(|&s| s > 0.0));
            let texture = template.texture.clone();
            buildings[building].append_instance(&placed, instance.template, frame, texture);
        }
        City {
            name: grammar.name.clone(),
            reference_system: grammar.reference_system.clone(),
            origin: grammar.origin,
            buildings,
            notes: Vec::new(),
        }
    }
}
