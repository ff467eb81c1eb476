//! Facades as rules without sizes, as the method finds them, for a code that prices any rules.

use edifice_base::{Error, Result};
use edifice_grammar::parametric::{Item, Parse, Rule, Rules, Symbol};
use edifice_procedural_logic::{Alphabet, Model, NaryNode, NaryTree, Parameters};
use edifice_shape::{Facade, LabelGrid};

use edifice_frame::Parsed;

/// Learns affinities and rules from some facades (parameters for compression) and parses them and others.
///
/// # Errors
/// Those of the method, and for facades that are no tilings.
pub fn parsed(learnt: &[Facade], others: &[Facade], step: f64) -> Result<Parsed> {
    let grid = |facade: &Facade| LabelGrid::from_facade(facade, None).map_err(Error::method);
    let grids: Vec<LabelGrid> = learnt.iter().map(grid).collect::<Result<_>>()?;
    let mut model = Model::fit(&grids, Parameters::COMPRESSION).map_err(Error::method)?;
    let mut rules = Rules::default();
    let mut known = Vec::with_capacity(learnt.len());
    for facade in &model.facades {
        let tree = model.inference.rules.expand(&facade.instance);
        let tree = tree.map_err(Error::method)?;
        known.push(add(&tree, &model.alphabet, step, &mut rules));
    }
    let mut unknown = Vec::with_capacity(others.len());
    for facade in others {
        let tree = model.parse(&grid(facade)?).map_err(Error::method)?;
        let tree = NaryTree::from_binary(&tree);
        let mut own = rules.clone();
        let parse = add(&tree, &model.alphabet, step, &mut own);
        unknown.push((parse, own));
    }
    Ok(Parsed {
        rules,
        learnt: known,
        others: unknown,
    })
}

/// Adds the rules of a tree to a table.
fn add(tree: &NaryTree, alphabet: &Alphabet, step: f64, rules: &mut Rules) -> Parse {
    let steps = |length: f64| (length / step).round() as u32;
    let mut symbols = vec![Symbol::Terminal(0); tree.nodes.len()];
    // Every child comes after its parent.
    for (node, content) in tree.nodes.iter().enumerate().rev() {
        symbols[node] = match content {
            NaryNode::Insert(label) => rules.label(alphabet.name(*label)),
            NaryNode::Split { axis, children, .. } => {
                let items = children
                    .iter()
                    .map(|&child| Item::Part(symbols[child as usize]));
                rules.intern(Rule {
                    axis: *axis,
                    items: items.collect(),
                })
            }
        };
    }
    let mut sizes = Vec::new();
    let mut todo = vec![0_u32];
    while let Some(node) = todo.pop() {
        if let NaryNode::Split {
            sizes: own,
            children,
            ..
        } = &tree.nodes[node as usize]
        {
            sizes.extend(own[..own.len() - 1].iter().map(|&size| steps(size)));
            todo.extend(children.iter().rev());
        }
    }
    Parse {
        root: symbols[0],
        extent: [steps(tree.width), steps(tree.height)],
        counts: Vec::new(),
        sizes,
    }
}
