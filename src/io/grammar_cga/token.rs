//! From text to tokens.

use std::fmt;

use chumsky::span::SimpleSpan;
use logos::Logos;

use super::error::Fault;

/// Deepest nesting of braces, brackets and parentheses; more is no grammar, and would exhaust the stack.
const NESTING: usize = 64;

/// A token of CGA text. Comments are skipped, except ours, which begin with `//@`.
#[derive(Logos, Debug, Clone, Copy, PartialEq)]
#[logos(skip r"[ \t\r\n\f]+")]
#[logos(skip(r"//([^@\n][^\n]*)?|#[^\n]*", allow_greedy = true))]
#[logos(skip r"/\*([^*]|\*+[^*/])*\*+/")]
pub(super) enum Token<'a> {
    #[regex(r"//@[^\n]*", |lex| lex.slice(), allow_greedy = true)]
    Note(&'a str),
    #[regex(r"[A-Za-z_][A-Za-z0-9_.]*", |lex| lex.slice())]
    Name(&'a str),
    #[regex(r"([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?", |lex| lex.slice())]
    Number(&'a str),
    #[regex(r#""[^"\n]*""#, |lex| lex.slice())]
    Text(&'a str),
    #[token("-->")]
    Arrow,
    #[token("{")]
    OpenBrace,
    #[token("}")]
    CloseBrace,
    #[token("(")]
    OpenParen,
    #[token(")")]
    CloseParen,
    #[token("[")]
    OpenBracket,
    #[token("]")]
    CloseBracket,
    #[token("<")]
    Less,
    #[token(":")]
    Colon,
    #[token("|")]
    Bar,
    #[token("*")]
    Star,
    #[token("%")]
    Percent,
    #[token("~")]
    Tilde,
    #[token("=")]
    Equals,
    #[token("+")]
    Plus,
    #[token("-")]
    Minus,
    #[token("/")]
    Slash,
    #[token("@")]
    At,
    #[token(",")]
    Comma,
    #[token("'")]
    Quote,
}

impl fmt::Display for Token<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = match self {
            Token::Note(s) | Token::Name(s) | Token::Number(s) | Token::Text(s) => s,
            Token::Arrow => "-->",
            Token::OpenBrace => "{",
            Token::CloseBrace => "}",
            Token::OpenParen => "(",
            Token::CloseParen => ")",
            Token::OpenBracket => "[",
            Token::CloseBracket => "]",
            Token::Less => "<",
            Token::Colon => ":",
            Token::Bar => "|",
            Token::Star => "*",
            Token::Percent => "%",
            Token::Tilde => "~",
            Token::Equals => "=",
            Token::Plus => "+",
            Token::Minus => "-",
            Token::Slash => "/",
            Token::At => "@",
            Token::Comma => ",",
            Token::Quote => "'",
        };
        f.write_str(text)
    }
}

/// The tokens with their places in the text.
pub(super) fn tokens(text: &str) -> Result<Vec<(Token<'_>, SimpleSpan)>, Fault> {
    let mut out = Vec::new();
    let mut depth = 0usize;
    for (token, span) in Token::lexer(text).spanned() {
        let span: SimpleSpan = span.into();
        let token = token.map_err(|()| Fault::new(span, "this character has no meaning here"))?;
        match token {
            Token::OpenBrace | Token::OpenParen | Token::OpenBracket => depth += 1,
            Token::CloseBrace | Token::CloseParen | Token::CloseBracket => {
                depth = depth.saturating_sub(1)
            }
            _ => {}
        }
        if depth > NESTING {
            return Err(Fault::new(span, "nested too deeply"));
        }
        out.push((token, span));
    }
    Ok(out)
}
