//! Grammars: text, JSON, derivation, sizes and scenes.

mod cga;
mod cga_reference;
mod cga_sizes;
mod cli;
mod derive;
mod json;
mod resize;
mod scene;
mod shipped_sizes;
mod support;
