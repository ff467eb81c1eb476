//! From a start shape to solids.

use std::cell::Cell;
use std::collections::BTreeMap;

use chumsky::span::SimpleSpan;
use rustc_hash::FxHashMap;

use super::super::error::Fault;
use super::syntax::{Expression, Kind, Operation, Program};
use super::{Scope, Solid};

/// Deepest nesting of rules and of functions.
const DEEPEST: usize = 32;
/// Most rules that one start shape applies.
const MOST_RULES: usize = 100_000;
/// Most calls of functions for one start shape.
const MOST_CALLS: usize = 1_000_000;

/// Everything that a rule puts into a scope.
pub(super) fn evaluate(
    program: &Program<'_>,
    start: &str,
    attributes: &BTreeMap<String, f64>,
    scope: Scope,
) -> Result<Vec<Solid>, Fault> {
    let mut evaluator = Evaluator {
        program,
        values: FxHashMap::default(),
        rules: 0,
        calls: Cell::new(0),
        solids: Vec::new(),
    };
    for (name, expression, may_be_stated) in &program.values {
        let value = match attributes.get(*name).filter(|_| *may_be_stated) {
            Some(&stated) => stated,
            None => evaluator.number(expression, &scope)?,
        };
        evaluator.values.insert(name, value);
    }
    evaluator.rule(start, (0..0).into(), scope, 0)?;
    Ok(evaluator.solids)
}

struct Evaluator<'p> {
    program: &'p Program<'p>,
    values: FxHashMap<&'p str, f64>,
    rules: usize,
    calls: Cell<usize>,
    solids: Vec<Solid>,
}

impl<'p> Evaluator<'p> {
    fn rule(
        &mut self,
        name: &str,
        span: SimpleSpan,
        scope: Scope,
        depth: usize,
    ) -> Result<(), Fault> {
        let Some(operations) = self.program.rules.get(name) else {
            return Err(Fault::new(span, format!("{name} has no rule")));
        };
        self.rules += 1;
        if depth > DEEPEST || self.rules > MOST_RULES {
            return Err(Fault::new(span, "rules go on without end"));
        }
        self.operations(operations, scope, depth)
    }

    fn operations(
        &mut self,
        operations: &'p [Operation<'p>],
        mut scope: Scope,
        depth: usize,
    ) -> Result<(), Fault> {
        for operation in operations {
            match operation {
                Operation::Translate(by, span) => {
                    let by = self.three(by, *span, &scope)?;
                    scope.at = scope.point(by);
                }
                Operation::Rotate(by, span) => {
                    let [x, y, z] = self.three(by, *span, &scope)?;
                    if x != 0.0 || z != 0.0 {
                        return Err(Fault::new(*span, "turns about y alone are read here"));
                    }
                    scope.turn += y;
                }
                Operation::Size(to, span) => scope.size = self.three(to, *span, &scope)?,
                Operation::Insert(asset, span) => {
                    if !scope.size.iter().all(|&s| s > 0.0) {
                        let message = format!("a scope of {:?} has no extent", scope.size);
                        return Err(Fault::new(*span, message));
                    }
                    self.solids.push(Solid {
                        asset: asset.map(str::to_owned),
                        scope,
                    });
                }
                Operation::Nothing => {}
                Operation::Aside(inside) => self.operations(inside, scope, depth)?,
                Operation::Symbol(name, span) => self.rule(name, *span, scope, depth + 1)?,
            }
        }
        Ok(())
    }

    fn three(
        &self,
        three: &[Expression<'_>; 3],
        span: SimpleSpan,
        scope: &Scope,
    ) -> Result<[f64; 3], Fault> {
        let mut out = [0.0; 3];
        for (value, expression) in out.iter_mut().zip(three) {
            *value = self.number(expression, scope)?;
            if !value.is_finite() {
                return Err(Fault::new(span, format!("{value} is no length or turn")));
            }
        }
        Ok(out)
    }

    fn number(&self, expression: &Expression<'_>, scope: &Scope) -> Result<f64, Fault> {
        let frame = Frame {
            scope,
            locals: FxHashMap::default(),
            depth: 0,
        };
        self.value(expression, &frame)
    }

    fn value(&self, expression: &Expression<'_>, frame: &Frame<'_>) -> Result<f64, Fault> {
        let fault = |message: String| Err(Fault::new(expression.span, message));
        Ok(match &expression.kind {
            Kind::Number(value) => *value,
            Kind::Name(name) => match (frame.locals.get(name), self.values.get(name), *name) {
                (Some(&value), _, _) | (None, Some(&value), _) => value,
                (None, None, "scope.sx") => frame.scope.size[0],
                (None, None, "scope.sy") => frame.scope.size[1],
                (None, None, "scope.sz") => frame.scope.size[2],
                _ => return fault(format!("{name} has no value above this line")),
            },
            Kind::Negative(value) => -self.value(value, frame)?,
            Kind::Chain(first, rest) => {
                let mut left = self.value(first, frame)?;
                for (sign, right) in rest {
                    let right = self.value(right, frame)?;
                    left = match sign {
                        '+' => left + right,
                        '-' => left - right,
                        '*' => left * right,
                        _ => left / right,
                    };
                }
                left
            }
            Kind::Case(parts) => {
                let less = self.value(&parts[0], frame)? < self.value(&parts[1], frame)?;
                self.value(&parts[if less { 2 } else { 3 }], frame)?
            }
            Kind::Call(name, arguments) => {
                let arguments = arguments.iter().map(|a| self.value(a, frame));
                let arguments: Vec<f64> = arguments.collect::<Result<_, _>>()?;
                match (*name, arguments.as_slice()) {
                    ("floor", &[v]) => v.floor(),
                    ("rint", &[v]) => v.round_ties_even(),
                    ("sqrt", &[v]) => v.sqrt(),
                    _ => {
                        let Some(function) = self.program.functions.get(name) else {
                            return fault(format!("the function {name} is not read here"));
                        };
                        let parameters = &function.parameters;
                        if parameters.len() != arguments.len() {
                            let count = parameters.len();
                            return fault(format!("{name} takes {count} numbers"));
                        }
                        self.calls.set(self.calls.get() + 1);
                        if frame.depth >= DEEPEST || self.calls.get() > MOST_CALLS {
                            return fault(format!("{name} goes on without end"));
                        }
                        let frame = Frame {
                            scope: frame.scope,
                            locals: parameters.iter().copied().zip(arguments).collect(),
                            depth: frame.depth + 1,
                        };
                        self.value(&function.body, &frame)?
                    }
                }
            }
        })
    }
}

/// The numbers that a function knows beside the values of the text.
struct Frame<'f> {
    scope: &'f Scope,
    locals: FxHashMap<&'f str, f64>,
    depth: usize,
}
