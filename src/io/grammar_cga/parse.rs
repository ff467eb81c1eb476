//! From tokens to statements.

use chumsky::error::RichReason;
use chumsky::input::{Stream, ValueInput};
use chumsky::prelude::*;

use super::error::Fault;
use super::syntax::{
    Alternative, At, Call, CgaRule, Chance, Entry, Expression, Item, Part, Prefix, Target,
};
use super::token::Token;
use edifice_shape::Axis;

type Extra<'t, 'a> = extra::Err<Rich<'t, Token<'a>>>;

/// Parses the statements of CGA text of `length` bytes.
pub(super) fn items<'a>(
    tokens: Vec<(Token<'a>, SimpleSpan)>,
    length: usize,
) -> Result<Vec<Item<'a>>, Fault> {
    let end: SimpleSpan = (length..length).into();
    let stream = Stream::from_iter(tokens).map(end, |(token, span): (_, _)| (token, span));
    file().parse(stream).into_result().map_err(|errors| {
        let first = errors.into_iter().min_by_key(|e| e.span().start);
        first.map_or_else(|| Fault::new(end, "not a grammar"), |e| fault(&e))
    })
}

fn fault(error: &Rich<'_, Token<'_>>) -> Fault {
    let message = match error.reason() {
        RichReason::Custom(message) => message.clone(),
        RichReason::ExpectedFound { expected, found } => {
            let mut wanted: Vec<String> = expected.iter().map(ToString::to_string).collect();
            wanted.sort();
            wanted.dedup();
            let found = match found {
                Some(token) => format!("'{}'", **token),
                None => "the end of the text".to_owned(),
            };
            format!("found {found}, expected {}", wanted.join(" or "))
        }
    };
    Fault::new(*error.span(), message)
}

fn word<'t, 'a: 't, I>(word: &'static str) -> impl Parser<'t, I, (), Extra<'t, 'a>> + Clone
where
    I: ValueInput<'t, Token = Token<'a>, Span = SimpleSpan>,
{
    select! { Token::Name(name) if name == word => () }.labelled(word)
}

fn file<'t, 'a: 't, I>() -> impl Parser<'t, I, Vec<Item<'a>>, Extra<'t, 'a>>
where
    I: ValueInput<'t, Token = Token<'a>, Span = SimpleSpan>,
{
    let reserved = ["attr", "const", "version", "else", "split", "case"];
    // A dot behind a name says that it is a leaf; it is no part of the name.
    let name = select! {
        Token::Name(name) if !reserved.contains(&name) => name.strip_suffix('.').unwrap_or(name)
    }
    .labelled("a symbol");
    let note = select! { Token::Note(note) = e => (note, e.span()) };
    let notes = note.repeated().collect::<Vec<At<&str>>>();

    let expression = recursive(|expression| {
        let number =
            select! { Token::Number(text) => Expression::Number(text) }.labelled("a number");
        let constant = name.map(Expression::Name).labelled("a constant");
        let arguments = expression
            .clone()
            .separated_by(just(Token::Comma))
            .at_most(2)
            .collect::<Vec<_>>()
            .delimited_by(just(Token::OpenParen), just(Token::CloseParen));
        let between = word("rand").ignore_then(arguments).map(|arguments| {
            let mut from_last = arguments.into_iter().rev();
            let high = from_last.next().unwrap_or(Expression::Number("1"));
            let low = from_last.next().unwrap_or(Expression::Number("0"));
            Expression::Between(Box::new(low), Box::new(high))
        });
        let group = expression.delimited_by(just(Token::OpenParen), just(Token::CloseParen));
        let atom = choice((number, between, constant, group));
        let signed = just(Token::Minus)
            .or_not()
            .then(atom)
            .map(|(minus, value)| match minus {
                Some(_) => Expression::Negative(Box::new(value)),
                None => value,
            });
        let binary =
            |left, (sign, right)| Expression::Binary(Box::new(left), sign, Box::new(right));
        let factor = choice((just(Token::Star).to('*'), just(Token::Slash).to('/')));
        let product = signed.clone().foldl(factor.then(signed).repeated(), binary);
        let sign = choice((just(Token::Plus).to('+'), just(Token::Minus).to('-')));
        product.clone().foldl(sign.then(product).repeated(), binary)
    });
    let expression = expression.map_with(|value, e| (value, e.span()));

    let target = recursive(|target| {
        let axis = select! { Token::Name("x") => Axis::X, Token::Name("y") => Axis::Y }
            .labelled("x or y")
            .delimited_by(just(Token::OpenParen), just(Token::CloseParen));
        let prefix = choice((
            just(Token::Tilde).to(Prefix::Floating),
            just(Token::Quote).to(Prefix::Fraction),
        ));
        let part = prefix
            .or_not()
            .then(expression.clone())
            .then_ignore(just(Token::Colon))
            .then(target)
            .map(|((prefix, size), target)| Part {
                prefix: prefix.unwrap_or(Prefix::Absolute),
                size,
                target,
            });
        let body = recursive(|body| {
            let group = body
                .then(just(Token::Star).or_not())
                .map_with(|(entries, star), e| match star {
                    Some(_) => vec![Entry::Repeat(entries, e.span())],
                    None => entries,
                });
            choice((group, part.map(|part| vec![Entry::Part(part)])))
                .separated_by(just(Token::Bar))
                .at_least(1)
                .collect::<Vec<Vec<Entry>>>()
                .map(|entries| entries.into_iter().flatten().collect::<Vec<Entry>>())
                .delimited_by(just(Token::OpenBrace), just(Token::CloseBrace))
        });
        let split = word("split")
            .ignore_then(axis)
            .then(body)
            .then(just(Token::Star).map_with(|_, e| e.span()).or_not())
            .map(|((axis, body), star)| match star {
                None => Target::Split(axis, body),
                Some(star) => Target::Split(axis, vec![Entry::Repeat(body, star)]),
            });
        let arguments = recursive(|arguments| {
            let text = none_of([Token::OpenParen, Token::CloseParen]).ignored();
            choice((arguments, text))
                .repeated()
                .delimited_by(just(Token::OpenParen), just(Token::CloseParen))
        });
        let numbers = expression
            .clone()
            .separated_by(just(Token::Comma))
            .at_least(1)
            .collect::<Vec<_>>()
            .delimited_by(just(Token::OpenParen), just(Token::CloseParen));
        // What the next rule takes is not what this one becomes.
        let call = name
            .map_with(|name, e| (name, e.span()))
            .then(choice((numbers.map(Some), arguments.to(None))))
            .then_ignore(just(Token::Arrow).not())
            .map(|(name, numbers)| Call { name, numbers });
        let calls = call.repeated().at_least(1).collect::<Vec<Call>>();
        // The name of the next rule is not what this one becomes.
        let next = choice((just(Token::Arrow), just(Token::OpenParen)));
        let symbol = name.then_ignore(next.not());
        let after = choice((split.clone(), symbol.map(Target::Symbol)));
        let called = calls
            .then(after.or_not())
            .map(|(calls, target)| Target::Calls(calls, target.map(Box::new)));
        choice((split, called, name.map(Target::Symbol))).map_with(|target, e| (target, e.span()))
    });

    let percent = expression
        .clone()
        .then_ignore(just(Token::Percent))
        .map(Chance::Percent);
    let chance = choice((percent, word("else").to(Chance::Else))).then_ignore(just(Token::Colon));
    let alternative = |chance: Chance<'a>, (notes, target)| Alternative {
        notes,
        chance,
        target,
    };
    let weighted = notes
        .then(chance)
        .then(target.clone())
        .map(move |((notes, chance), target)| alternative(chance, (notes, target)))
        .repeated()
        .at_least(1)
        .collect::<Vec<_>>();
    let single = notes
        .then(target)
        .map(move |rest| vec![alternative(Chance::Always, rest)]);
    let parameters = name
        .separated_by(just(Token::Comma))
        .collect::<Vec<_>>()
        .delimited_by(just(Token::OpenParen), just(Token::CloseParen));
    let rule = notes
        .then(name.map_with(|name, e| (name, e.span())))
        .then(parameters.or_not().map(Option::unwrap_or_default))
        .then_ignore(just(Token::Arrow))
        .then(choice((weighted, single)))
        .map(|(((notes, name), parameters), alternatives)| {
            Item::Rule(Box::new(CgaRule {
                notes,
                name,
                parameters,
                alternatives,
            }))
        });
    let text = select! { Token::Text(_) => () }.labelled("a quoted text");
    let constant = choice((word("attr"), word("const")))
        .ignore_then(name.map_with(|name, e| (name, e.span())))
        .then_ignore(just(Token::Equals))
        .then(expression)
        .map(|(name, value)| Item::Constant(name, value));
    let argument = none_of([Token::CloseParen]).ignored();
    let arguments = argument
        .repeated()
        .delimited_by(just(Token::OpenParen), just(Token::CloseParen));
    let annotation = just(Token::At)
        .ignore_then(select! { Token::Name(name) => name }.labelled("an annotation"))
        .then_ignore(arguments.or_not())
        .map(|name| match name {
            "StartRule" => Item::StartRule,
            _ => Item::Skipped,
        });
    let version = word("version").then(text).to(Item::Skipped);
    choice((version, annotation, constant, rule))
        .repeated()
        .collect::<Vec<_>>()
        .then_ignore(end())
}
