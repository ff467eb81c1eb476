//! Structure completion (Fan, Musialski, Liu, Wonka 2014, *Structure Completion for Facade Layouts*).

pub mod annealing;
pub mod baselines;
pub mod best;
pub mod completion;
pub mod layout;
pub mod measure;
pub mod method;
pub mod model;
pub mod model_file;
pub mod partial;
pub mod policy;
pub mod score;
pub mod task;
