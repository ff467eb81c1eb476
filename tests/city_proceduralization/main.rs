//! Cities: grammars, files and commands.

mod commands;
mod compact;
mod gltf;
mod grammar;
mod interrupted;
mod invariance;
mod textures;
