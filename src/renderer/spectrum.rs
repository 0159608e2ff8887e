//! The spectrum of a plan's series, on the device.

use super::{Field, convert};
use crate::Result;
use crate::gpu::layout::SpectralGhost;
use crate::gpu::spectrum::{Coefficients, Ghosts, SpectrumGroup};
use crate::plan::{Group, Plan, Precision, Series, Transform};
use crate::series::moments::Sums;

/// What a group, or one of its sizes, adds to the spectrum.
struct Part<'a> {
    group: &'a Group,
    table: Option<Vec<[f32; 4]>>,
    ghosts: Ready,
}

enum Ready {
    Each(Vec<SpectralGhost>),
    Sums(Vec<Sums>),
}

impl Field {
    /// Computes the spectrum of a plan's series, or uploads the modes that the plan has computed.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub(super) fn compute_spectrum(&mut self, plan: &Plan, series: &Series) -> Result<()> {
        if series.precision == Precision::Double {
            let modes = self.runner.run("modes", || plan.exact_modes());
            return self.exact.set_spectrum(&series.counts, modes.as_flattened());
        }
        if let Some(modes) = &series.modes {
            let terms = self.runner.run("modes", || convert::terms(plan, series, modes));
            return self.spectrum.upload(&series.counts, &terms);
        }
        let parts: Vec<Part<'_>> = series.groups.iter().flat_map(|group| self.parts(plan, series, group)).collect();
        let groups = parts.iter().map(|Part { group, table, ghosts }| SpectrumGroup {
            coefficients: match table {
                Some(table) => Coefficients::Table(table),
                None => Coefficients::Factors(group.bell.shape().shader()),
            },
            ghosts: match ghosts {
                Ready::Each(ghosts) => Ghosts::Each(ghosts),
                Ready::Sums(sums) => Ghosts::Sums(sums),
            },
            degree: group.degree,
        });
        self.spectrum.compute(&self.runner, &series.counts, &groups.collect::<Vec<_>>())
    }

    /// What a group adds to the spectrum: its ghosts, or sums over them for each of a few sizes.
    fn parts<'a>(&self, plan: &Plan, series: &Series, group: &'a Group) -> Vec<Part<'a>> {
        let Transform::Gather(gathering) = &group.transform else {
            let table = group.bell.shape().tabulated().then(|| convert::table(series, group, group.smallest));
            let ghosts = Ready::Each(convert::spectral_ghosts(plan, series.period, &group.members));
            return vec![Part { group, table, ghosts }];
        };
        let gathered = || gathering.sums(plan.problem().ghosts(), group, series.period, plan.scale);
        let part = |(size, sums)| {
            let table = Some(convert::table(series, group, size));
            Part { group, table, ghosts: Ready::Sums(sums) }
        };
        self.runner.run("moments", gathered).into_iter().map(part).collect()
    }

    /// Computes the spectrum of ghosts whose bell is a table, whatever bells they name: for each mode that the plan
    /// keeps, harmonic by harmonic of x, what stands before c_n c_m, s_n s_m, c_n s_m and s_n c_m in the bell's series
    /// about its own centre, the mode's weight 1, 2 or 4 included.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub(crate) fn set_tabulated(&mut self, plan: &Plan, table: &[[f32; 4]]) -> Result<()> {
        self.forget_scene();
        let everyone: Vec<u32> = (0..plan.problem().ghosts().len() as u32).collect();
        let group = SpectrumGroup {
            coefficients: Coefficients::Table(table),
            ghosts: Ghosts::Each(&convert::spectral_ghosts(plan, plan.period(), &everyone)),
            degree: plan.degree(),
        };
        self.spectrum.compute(&self.runner, plan.counts(), &[group])?;
        self.runner.device().check("computing the spectrum")?;
        self.scene = Some(plan.clone());
        Ok(())
    }

    /// Rounds the spectrum as a store of 16-bit floats would, whose scale is its largest term: what such a store would
    /// cost in accuracy. The next [`Field::set_scene`] of the same plan keeps it; [`Field::forget_scene`] does not.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses.
    pub(crate) fn round_spectrum(&mut self) -> Result<()> {
        self.spectrum.round_to_half()
    }
}
