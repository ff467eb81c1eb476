//! Statistics of comparisons between arms over instances and seeds.
//!
//! | what | how |
//! | --- | --- |
//! | intervals | percentile bootstrap that resamples instances, then seeds within each (hierarchical bootstrap: Davison and Hinkley 1997, Sec. 3.8) |
//! | paired differences | Wilcoxon's signed-rank test on the instances' means, two-sided; exact without ties up to 50 instances, else normal with ties corrected (as SciPy's `wilcoxon(zero_method="wilcox", correction=False)`) |
//! | several comparisons | Holm 1979 |
//! | effect size | matched-pairs rank biserial correlation (Kerby 2014): favourable minus unfavourable share of the rank sum |
//! | ranks | Friedman 1937, critical difference of Nemenyi (Demsar 2006) |
//! | profiles | share of instances within a factor of the best arm (Dolan and More 2002), failures at infinity |

mod bootstrap;
mod profiles;
mod ranks;
mod wilcoxon;

pub use bootstrap::{Interval, bootstrap};
pub use profiles::{profile, reached};
pub use ranks::{Ranks, ranks};
pub use wilcoxon::{Signed, holm, signed_rank};
