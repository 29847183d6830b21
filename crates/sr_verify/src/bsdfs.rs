//! Scattering models: all checks on all of `sr_testing`'s.

use glam::Vec3;
use sr_bsdf::{AnyBsdf, Bsdf};
use sr_testing::bsdfs::{energy_limit, is_reciprocal};
use sr_testing::{bsdf_cases, bsdf_models, lossless_models};

use crate::bsdf_checks as checks;
use crate::directions::{self, BINS};
use crate::picture::Picture;
use crate::subject::{Group, Subject};

/// From along the normal and from grazing angles, where single numbers are checked, but no integrals.
fn hard_directions() -> [Vec3; 3] {
    [Vec3::Z, Vec3::new(0.6, 0.8, 0.02), Vec3::new(0.8, -0.6, 1e-3)].map(Vec3::normalize)
}

pub fn subjects() -> Vec<Subject> {
    let mut all: Vec<Subject> =
        bsdf_cases().into_iter().map(|(case, bsdf, wo)| whole(case, bsdf, wo)).collect();
    for (name, bsdf) in bsdf_models() {
        for wo in hard_directions() {
            all.push(pointwise(Subject::new(Group::Bsdf, format!("{name}, from {wo}")), bsdf, wo));
        }
    }
    for (name, bsdf) in lossless_models() {
        for wo in [Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.98, 0.2)].map(Vec3::normalize) {
            let name = name.strip_prefix("white ").unwrap_or(&name);
            let subject = Subject::new(Group::Bsdf, format!("{name}, white, from {wo}"));
            let check = move |seed| checks::white_furnace(&bsdf, wo, 1e-3, seed);
            all.push(subject.check("white furnace", check));
        }
    }
    all
}

/// Every check on a model, seen from a direction.
pub fn whole<B: Bsdf + Copy + Send + Sync + 'static>(case: String, bsdf: B, wo: Vec3) -> Subject {
    let mut subject = Subject::new(Group::Bsdf, case);
    if checks::scatters(&bsdf, wo) {
        subject = subject
            .check("chi-square", move |seed| directions::chi_square(&bsdf.given(wo), BINS, seed))
            .check("normalised", move |seed| directions::normalised(&bsdf.given(wo), BINS, seed))
            .picture(move |seed| Picture::of(&bsdf.given(wo), seed));
    }
    if bsdf.lobes().delta {
        subject = subject.check("delta lobes", move |seed| checks::delta_lobes(&bsdf, wo, seed));
    }
    pointwise(subject, bsdf, wo)
}

fn pointwise<B: Bsdf + Copy + Send + Sync + 'static>(subject: Subject, bsdf: B, wo: Vec3) -> Subject {
    let (limit, is_reciprocal) = (energy_limit(&subject.case), is_reciprocal(&subject.case));
    let tilted = subject.case.starts_with("tilted");
    let subject = subject
        .check("sample = eval / pdf", move |seed| checks::sample_is_eval_and_pdf(&bsdf, wo, seed))
        .check("covered", move |seed| checks::covered(&bsdf, wo, seed))
        .check("energy", move |seed| checks::energy(&bsdf, wo, limit, seed))
        .check("finite", move |seed| checks::finite(&bsdf, wo, tilted, seed));
    if !is_reciprocal {
        return subject;
    }
    subject.check("reciprocal", move |seed| checks::reciprocal(&bsdf, wo, seed))
}

/// A few of each block, for what takes long.
pub fn examples() -> Vec<(String, AnyBsdf<'static>, Vec3)> {
    let cases = bsdf_cases();
    let mut seen: Vec<(String, usize)> = Vec::new();
    let mut few = Vec::new();
    for case in cases {
        let block = Subject::new(Group::Bsdf, case.0.clone()).block;
        let count = match seen.iter_mut().find(|(known, _)| *known == block) {
            Some((_, count)) => count,
            None => {
                seen.push((block, 0));
                &mut seen.last_mut().expect("just added").1
            }
        };
        *count += 1;
        // Neighbours in the list are the same model from other directions.
        if *count % 19 == 2 && *count < 60 {
            few.push(case);
        }
    }
    few
}
