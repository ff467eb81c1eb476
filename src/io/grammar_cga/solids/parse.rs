//! From tokens to statements that make solids.

use chumsky::span::SimpleSpan;

use super::super::error::Fault;
use super::super::token::{Token, tokens};
use super::syntax::{Expression, Function, Kind, Operation, Program};

/// Words that begin a statement or a case, and no symbol.
const KEYWORDS: [&str; 5] = ["attr", "const", "version", "case", "else"];

/// Parses all statements.
pub(super) fn program(text: &str) -> Result<Program<'_>, Fault> {
    let mut tokens = tokens(text)?;
    tokens.retain(|(token, _)| !matches!(token, Token::Note(_)));
    let end = (text.len()..text.len()).into();
    let mut reader = Reader { tokens, at: 0, end };
    let mut out = Program::default();
    while reader.peek().is_some() {
        reader.statement(&mut out)?;
    }
    Ok(out)
}

struct Reader<'a> {
    tokens: Vec<(Token<'a>, SimpleSpan)>,
    at: usize,
    end: SimpleSpan,
}

impl<'a> Reader<'a> {
    fn peek(&self) -> Option<Token<'a>> {
        self.tokens.get(self.at).map(|t| t.0)
    }

    fn span(&self) -> SimpleSpan {
        self.tokens.get(self.at).map_or(self.end, |t| t.1)
    }

    fn wrong<T>(&self, expected: &str) -> Result<T, Fault> {
        let found = match self.peek() {
            Some(token) => format!("'{token}'"),
            None => "the end of the text".to_owned(),
        };
        let message = format!("found {found}, expected {expected}");
        Err(Fault::new(self.span(), message))
    }

    /// Steps over a token if it is next.
    fn takes(&mut self, token: Token<'_>) -> bool {
        let next = self.peek() == Some(token);
        self.at += usize::from(next);
        next
    }

    fn expect(&mut self, token: Token<'_>) -> Result<(), Fault> {
        match self.takes(token) {
            true => Ok(()),
            false => self.wrong(&format!("'{token}'")),
        }
    }

    fn name(&mut self) -> Result<(&'a str, SimpleSpan), Fault> {
        let span = self.span();
        match self.peek() {
            Some(Token::Name(name)) if !KEYWORDS.contains(&name) => {
                self.at += 1;
                Ok((name, span))
            }
            _ => self.wrong("a name"),
        }
    }

    fn text(&mut self) -> Result<&'a str, Fault> {
        match self.peek() {
            Some(Token::Text(text)) => {
                self.at += 1;
                Ok(text.trim_matches('"'))
            }
            _ => self.wrong("a quoted text"),
        }
    }

    fn statement(&mut self, out: &mut Program<'a>) -> Result<(), Fault> {
        match self.peek() {
            Some(Token::At) => {
                self.at += 1;
                self.name()?;
                if self.takes(Token::OpenParen) {
                    while !self.takes(Token::CloseParen) {
                        if self.peek().is_none() {
                            return self.wrong("')'");
                        }
                        self.at += 1;
                    }
                }
                Ok(())
            }
            Some(Token::Name("version")) => {
                self.at += 1;
                self.text().map(|_| ())
            }
            Some(Token::Name(word @ ("attr" | "const"))) => {
                self.at += 1;
                let (name, span) = self.name()?;
                if out.values.iter().any(|v| v.0 == name) {
                    return Err(Fault::new(span, "this name has a value already"));
                }
                self.expect(Token::Equals)?;
                let value = self.expression()?;
                out.values.push((name, value, word == "attr"));
                Ok(())
            }
            _ => self.definition(out),
        }
    }

    /// A function or a rule.
    fn definition(&mut self, out: &mut Program<'a>) -> Result<(), Fault> {
        let (name, span) = self.name()?;
        let mut parameters = Vec::new();
        if self.takes(Token::OpenParen) {
            loop {
                parameters.push(self.name()?.0);
                if !self.takes(Token::Comma) {
                    break;
                }
            }
            self.expect(Token::CloseParen)?;
        }
        let twice = || Fault::new(span, "this name is defined already");
        if self.takes(Token::Equals) {
            let body = self.body()?;
            let function = Function { parameters, body };
            return match out.functions.insert(name, function) {
                Some(_) => Err(twice()),
                None => Ok(()),
            };
        }
        if !parameters.is_empty() {
            let message = "rules with parameters of their own are not read here";
            return Err(Fault::new(span, message));
        }
        self.expect(Token::Arrow)?;
        let operations = self.operations()?;
        match out.rules.insert(name, operations) {
            Some(_) => Err(twice()),
            None => Ok(()),
        }
    }

    /// True if a statement begins here: a keyword, or a name with what is defined of it.
    fn begins_statement(&self) -> bool {
        match self.peek() {
            None | Some(Token::At | Token::Name("attr" | "const" | "version")) => return true,
            Some(Token::Name(_)) => {}
            _ => return false,
        }
        let mut rest = self.tokens[self.at + 1..].iter().map(|t| t.0).peekable();
        if rest.next_if_eq(&Token::OpenParen).is_some() {
            let inside = |t: &Token<'_>| matches!(t, Token::Name(_) | Token::Comma);
            while rest.next_if(inside).is_some() {}
            if rest.next() != Some(Token::CloseParen) {
                return false;
            }
        }
        matches!(rest.next(), Some(Token::Arrow | Token::Equals))
    }

    fn operations(&mut self) -> Result<Vec<Operation<'a>>, Fault> {
        let mut out = Vec::new();
        while self.peek() != Some(Token::CloseBracket) && !self.begins_statement() {
            if self.takes(Token::OpenBracket) {
                let inside = self.operations()?;
                self.expect(Token::CloseBracket)?;
                out.push(Operation::Aside(inside));
                continue;
            }
            let (name, span) = self.name()?;
            if !self.takes(Token::OpenParen) {
                out.push(match name {
                    "NIL" => Operation::Nothing,
                    // A dot behind a name says that it is a leaf.
                    _ => Operation::Symbol(name.strip_suffix('.').unwrap_or(name), span),
                });
                continue;
            }
            out.push(match name {
                "i" => Operation::Insert(Some(self.text()?), span),
                "primitiveCube" => Operation::Insert(None, span),
                "alignScopeToGeometry" => {
                    self.expect(Token::Name("yUp"))?;
                    for _ in 0..2 {
                        self.expect(Token::Comma)?;
                        self.expect(Token::Number("0"))?;
                    }
                    Operation::Nothing
                }
                "t" => Operation::Translate(self.three()?, span),
                "r" => Operation::Rotate(self.three()?, span),
                "s" => Operation::Size(self.three()?, span),
                _ => {
                    let message = format!("the operation {name} is not read here");
                    return Err(Fault::new(span, message));
                }
            });
            self.expect(Token::CloseParen)?;
        }
        Ok(out)
    }

    fn three(&mut self) -> Result<[Expression<'a>; 3], Fault> {
        let x = self.expression()?;
        self.expect(Token::Comma)?;
        let y = self.expression()?;
        self.expect(Token::Comma)?;
        Ok([x, y, self.expression()?])
    }

    /// An expression, or a choice of two.
    fn body(&mut self) -> Result<Expression<'a>, Fault> {
        let span = self.span();
        if !self.takes(Token::Name("case")) {
            return self.expression();
        }
        let left = self.expression()?;
        self.expect(Token::Less)?;
        let right = self.expression()?;
        self.expect(Token::Colon)?;
        let then = self.expression()?;
        self.expect(Token::Name("else"))?;
        self.expect(Token::Colon)?;
        let kind = Kind::Case(Box::new([left, right, then, self.expression()?]));
        Ok(Expression { kind, span })
    }

    fn expression(&mut self) -> Result<Expression<'a>, Fault> {
        let sign = |token: Token<'_>| match token {
            Token::Plus => Some('+'),
            Token::Minus => Some('-'),
            _ => None,
        };
        self.chain(sign, Self::product)
    }

    fn product(&mut self) -> Result<Expression<'a>, Fault> {
        let sign = |token: Token<'_>| match token {
            Token::Star => Some('*'),
            Token::Slash => Some('/'),
            _ => None,
        };
        self.chain(sign, Self::factor)
    }

    /// One or more of what `part` reads, joined by signs.
    fn chain(
        &mut self,
        sign: fn(Token<'_>) -> Option<char>,
        part: fn(&mut Self) -> Result<Expression<'a>, Fault>,
    ) -> Result<Expression<'a>, Fault> {
        let span = self.span();
        let first = part(self)?;
        let mut rest = Vec::new();
        while let Some(sign) = self.peek().and_then(sign) {
            self.at += 1;
            rest.push((sign, part(self)?));
        }
        if rest.is_empty() {
            return Ok(first);
        }
        let kind = Kind::Chain(Box::new(first), rest);
        Ok(Expression { kind, span })
    }

    fn factor(&mut self) -> Result<Expression<'a>, Fault> {
        let span = self.span();
        let negative = self.takes(Token::Minus);
        let atom = self.atom()?;
        let kind = match negative {
            true => Kind::Negative(Box::new(atom)),
            false => return Ok(atom),
        };
        Ok(Expression { kind, span })
    }

    fn atom(&mut self) -> Result<Expression<'a>, Fault> {
        let span = self.span();
        let kind = match self.peek() {
            Some(Token::Number(text)) => {
                self.at += 1;
                let wrong = |_| Fault::new(span, format!("{text} is not a number"));
                Kind::Number(text.parse().map_err(wrong)?)
            }
            Some(Token::OpenParen) => {
                self.at += 1;
                let inside = self.expression()?;
                self.expect(Token::CloseParen)?;
                return Ok(inside);
            }
            Some(Token::Name(_)) => {
                let (name, _) = self.name()?;
                match self.takes(Token::OpenParen) {
                    true => Kind::Call(name, self.arguments()?),
                    false => Kind::Name(name),
                }
            }
            _ => return self.wrong("a number or a name"),
        };
        Ok(Expression { kind, span })
    }

    fn arguments(&mut self) -> Result<Vec<Expression<'a>>, Fault> {
        let mut out = vec![self.expression()?];
        while self.takes(Token::Comma) {
            out.push(self.expression()?);
        }
        self.expect(Token::CloseParen)?;
        Ok(out)
    }
}
