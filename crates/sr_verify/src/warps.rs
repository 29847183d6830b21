//! What the renderer samples with: warps, tables, mixtures, in single precision.

use std::sync::Arc;

use sr_stats::Chi2Settings;
use sr_testing::distribution_cases;

use crate::subject::{Group, Subject, Verdict};

const SETTINGS: Chi2Settings = Chi2Settings { samples: 1 << 18, bins: (16, 32), seed: 0 };

pub fn subjects() -> Vec<Subject> {
    let each = |case: sr_testing::DistributionCase| {
        let case = Arc::new(case);
        let same = Arc::clone(&case);
        let mut subject = Subject::new(Group::Warp, case.name.clone())
            .check("chi-square", move |seed| Verdict::Chance(case.chi2(Chi2Settings { seed, ..SETTINGS })));
        if same.round_trip(0).is_some() {
            subject = subject.check("invert", move |seed| {
                let trip = same.round_trip(seed).expect("it was there");
                let enough = trip.tried > 9_000 && trip.missed == 0;
                Verdict::of((!enough).then(|| format!("{trip:?}")))
            });
        }
        subject
    };
    distribution_cases().into_iter().map(each).collect()
}
