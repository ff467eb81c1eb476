//! The studio without a browser: its documents, its API, who may ask it, and that saved scripts give the same bytes.

#![cfg(feature = "studio")]

#[path = "../common/cases.rs"]
mod cases;

mod api;
mod cities;
mod client;
mod crash;
mod editors;
mod floors;
mod grids;
mod guard;
mod jobs;
mod limits;
mod photograph;
mod recovery;
mod report;
mod saving;
mod scripts;
mod secrets;
mod socket;
mod speed;
mod straighten;
