//! Cities: grammars, files and commands.

mod box_textures;
mod commands;
mod compact;
mod gltf;
mod grammar;
mod interrupted;
mod invariance;
mod photographs;
mod textures;
