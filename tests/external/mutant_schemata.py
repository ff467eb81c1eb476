"""Mutant schemata (Untch et al., 1993): one build that holds all mutants of a sample, each behind a switch.

`instrument` writes the switches into a tree of sources: a mutated expression becomes `if crate::mutant(17) { mutated } else
{ unchanged }`, and a mutated function returns its replacement where `crate::mutant(17)` holds. The variable `EDIFICE_MUTANT`
of a run's environment turns one of them on; `EDIFICE_MUTANTS_REACHED` names a file to which a run appends the numbers of those
that it came past. Mutants are those of `cargo mutants --list --json`. Needs `pip install tree-sitter tree-sitter-rust`.
"""

import pathlib

import tree_sitter
import tree_sitter_rust

PARSER = tree_sitter.Parser(tree_sitter.Language(tree_sitter_rust.language()))

# Appended to the root file of each crate that holds mutants.
SWITCH = """
#[allow(missing_docs, unreachable_pub, dead_code, clippy::all)]
#[inline]
pub(crate) fn mutant(number: usize) -> bool {
    use std::sync::OnceLock;
    use std::sync::atomic::{AtomicBool, Ordering};
    static ACTIVE: OnceLock<usize> = OnceLock::new();
    static REACHED: [AtomicBool; LIMIT] = [const { AtomicBool::new(false) }; LIMIT];
    let active = *ACTIVE.get_or_init(|| match std::env::var("EDIFICE_MUTANT") {
        Ok(number) => number.parse().expect("EDIFICE_MUTANT is a number"),
        Err(_) if std::env::var_os("EDIFICE_MUTANTS_REACHED").is_some() => usize::MAX,
        Err(_) => usize::MAX - 1,
    });
    if active == usize::MAX && !REACHED[number].swap(true, Ordering::Relaxed) {
        use std::io::Write;
        let path = std::env::var_os("EDIFICE_MUTANTS_REACHED").expect("asked above");
        let mut file = std::fs::OpenOptions::new().create(true).append(true).open(path).expect("a file for reached mutants");
        file.write_all(format!("{number}\\n").as_bytes()).expect("a file for reached mutants");
    }
    active == number
}
"""


def offset(lines, place):
    """The byte of a place in a file of which `lines` holds the text and the first byte of each line."""
    text, start = lines[place["line"] - 1]
    return start + len(text[: place["column"] - 1].encode())


def line_starts(source):
    """Each line with its first byte."""
    lines, start = [], 0
    for raw in source.split(b"\n"):
        lines.append((raw.decode(), start))
        start += len(raw) + 1
    return lines


def node_at(root, start, kinds, operator=False):
    """The innermost node of one of the kinds around a byte; with `operator`, the one whose operator stands there."""
    node = root.descendant_for_byte_range(start, start)
    while node is not None:
        if node.type in kinds:
            if not operator or any(child.start_byte == start for child in node.children[:2]):
                return node
        node = node.parent
    return None


class Wrap:
    """A node of the source and what becomes of it: a function of a function that renders a part of the source."""

    def __init__(self, node):
        self.start, self.end, self.node, self.cases = node.start_byte, node.end_byte, node, []


def plan(root, lines, number, mutant, wraps, inserts):
    """Notes one mutant among the wraps (by node) or the insertions (by byte); says whether it could be expressed."""
    genre, new, start = mutant["genre"], mutant["replacement"], offset(lines, mutant["span"]["start"])
    end = offset(lines, mutant["span"]["end"])
    if genre == "FnValue":
        function = node_at(root, start, ["function_item"])
        if function is None:
            return False
        body = function.child_by_field_name("body")
        inserts.append((body.start_byte + 1, f" if crate::mutant({number}) {{ return {new}; }} "))
        return True
    if genre == "BinaryOperator":
        node = node_at(root, start, ["binary_expression", "compound_assignment_expr"], operator=True)
        if node is None:
            return False
        left, _, right = node.children[:3]
        mutated = lambda part: f"{part(left.start_byte, left.end_byte)} {new} {part(right.start_byte, right.end_byte)}"
    elif genre == "UnaryOperator":
        node = node_at(root, start, ["unary_expression"], operator=True)
        if node is None:
            return False
        mutated = lambda part: part(node.children[1].start_byte, node.end_byte)
    elif genre == "MatchArmGuard":
        node = root.descendant_for_byte_range(start, end)
        mutated = lambda part: new
    elif genre == "MatchArm":
        arm = node_at(root, start, ["match_arm"])
        pattern = arm.child_by_field_name("pattern")
        guard = pattern.child_by_field_name("condition")
        if guard is None:
            inserts.append((pattern.end_byte, f" if !crate::mutant({number}) "))
        else:
            inserts.append((guard.start_byte, f" !crate::mutant({number}) && ("))
            inserts.append((guard.end_byte, ")"))
        return True
    elif genre == "StructField":
        node = node_at(root, start, ["struct_expression"])
        field = node_at(root, start, ["field_initializer", "shorthand_field_initializer"])
        after = field.next_sibling
        to = after.end_byte if after is not None and after.type == "," else field.end_byte
        mutated = lambda part: part(node.start_byte, field.start_byte) + part(to, node.end_byte)
    else:
        return False
    wrap = wraps.setdefault((node.start_byte, node.end_byte), Wrap(node))
    wrap.cases.append((number, mutated))
    return True


def render(source, start, end, wraps, inserts):
    """The text of a range with its outermost wraps applied, the ones within them too."""
    inside = sorted((w for w in wraps if start <= w.start and w.end <= end), key=lambda w: (w.start, -w.end))
    places = sorted((i for i in inserts if start <= i[0] <= end), key=lambda i: i[0])
    text, at = [], start

    def plain(to):
        nonlocal at
        for place, piece in [i for i in places if at <= i[0] < to or (i[0] == to == end)]:
            text.append(source[at:place].decode() + piece)
            at = place
        text.append(source[at:to].decode())
        at = to

    for wrap in inside:
        if wrap.start < at:
            continue
        plain(wrap.start)
        within = [w for w in wraps if w is not wrap]
        part = lambda a, b: render(source, a, b, within, inserts)
        branches = "".join(f"if crate::mutant({n}) {{ {mutated(part)} }} else " for n, mutated in wrap.cases)
        text.append(f"({branches}{{ {part(wrap.start, wrap.end)} }})")
        at = wrap.end
        places = [i for i in places if i[0] >= at]
    plain(end)
    return "".join(text)


def instrument(tree, mutants, roots):
    """Writes the numbered mutants into the files of the tree; `roots` gives the root file of a package.

    Returns the numbers of those that cannot be written as a switch.
    """
    files, packages, inexpressible = {}, set(), []
    for number, mutant in mutants.items():
        files.setdefault(mutant["file"], []).append((number, mutant))
    for name, inside in files.items():
        path = pathlib.Path(tree, name)
        source = path.read_bytes()
        root, lines = PARSER.parse(source).root_node, line_starts(source)
        wraps, inserts = {}, []
        for number, mutant in inside:
            if plan(root, lines, number, mutant, wraps, inserts):
                packages.add(mutant["package"])
            else:
                inexpressible.append(number)
        path.write_text(render(source, 0, len(source), list(wraps.values()), inserts))
    for package in packages:
        path = pathlib.Path(roots[package])
        path.write_text(path.read_text() + SWITCH.replace("LIMIT", str(max(mutants) + 1)))
    return inexpressible
