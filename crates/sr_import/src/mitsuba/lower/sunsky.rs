//! Clear skies: `sunsky`, and `sky` and `sun` alone.

use std::f64::consts::{PI, TAU};
use std::ops::RangeInclusive;

use glam::{DMat3, DVec3};
use sr_scene::{Diagnostic, LightDesc, Rgb};

use super::Lowering;
use super::color::Role;
use crate::mitsuba::node::Node;
use crate::mitsuba::props::Props;

/// When and where the sun is looked at.
struct Moment {
    year: i64,
    month: i64,
    day: i64,
    /// In the time zone's time.
    hour: f64,
    /// East of Greenwich and north, in degrees.
    longitude: f64,
    latitude: f64,
    /// Hours ahead of Greenwich.
    timezone: f64,
}

impl Moment {
    /// Towards the sun: +Z to the zenith, +X to the south, +Y to the west.
    ///
    /// Blanco-Muriel, Alarcón-Padilla, López-Moratalla & Lara-Coira, "Computing the Solar Vector", Solar Energy 70(5),
    /// 2001: within half a minute of arc from 1999 to 2015.
    fn sun(&self) -> DVec3 {
        let hours = self.hour - self.timezone;
        let shift = (self.month - 14) / 12;
        let julian_day = (1461 * (self.year + 4800 + shift)) / 4 + (367 * (self.month - 2 - 12 * shift)) / 12
            - (3 * ((self.year + 4900 + shift) / 100)) / 4
            + self.day
            - 32075;
        let days = julian_day as f64 - 0.5 + hours / 24.0 - 2_451_545.0;
        let omega = 2.1429 - 0.001_039_459_4 * days;
        let mean_longitude = 4.895_063_0 + 0.017_202_791_698 * days;
        let anomaly = 6.240_060_0 + 0.017_201_969_9 * days;
        let longitude = mean_longitude + 0.033_416_07 * anomaly.sin() + 0.000_348_94 * (2.0 * anomaly).sin()
            - 0.000_113_4
            - 0.000_020_3 * omega.sin();
        let obliquity = 0.409_092_8 - 6.2140e-9 * days + 0.000_039_6 * omega.cos();
        let right_ascension = (obliquity.cos() * longitude.sin()).atan2(longitude.cos()).rem_euclid(TAU);
        let declination = (obliquity.sin() * longitude.sin()).asin();
        let sidereal_time = 6.697_424_324_2 + 0.065_709_828_3 * days + hours;
        let hour_angle = (sidereal_time * 15.0 + self.longitude).to_radians() - right_ascension;
        let latitude = self.latitude.to_radians();
        let cos_zenith =
            latitude.cos() * hour_angle.cos() * declination.cos() + declination.sin() * latitude.sin();
        let zenith = cos_zenith.clamp(-1.0, 1.0).acos();
        // from the north, clockwise
        let azimuth = (-hour_angle.sin())
            .atan2(declination.tan() * latitude.cos() - latitude.sin() * hour_angle.cos())
            .rem_euclid(TAU);
        // the earth's radius over its distance from the sun: the parallax
        let zenith = zenith + 6371.01 / 149_597_890.0 * zenith.sin();
        let from_south = azimuth - PI;
        DVec3::new(zenith.sin() * from_south.cos(), zenith.sin() * from_south.sin(), zenith.cos())
    }
}

impl<'a> Lowering<'a, '_> {
    /// The lights of a clear sky.
    pub(super) fn sunsky(&mut self, node: &'a Node, props: &mut Props<'a>) -> Vec<LightDesc> {
        let to_world = props.transform("to_world", self.out.d);
        let Some(world_from_light) = self.rotation_of(to_world, "a sky", node) else { return Vec::new() };
        if self.origin.legacy {
            let message = format!("{} of Mitsuba 0.6, where up is +Y", node.title());
            self.out.d.push(
                Diagnostic::warning("mitsuba::sky-axis", &node.span, message)
                    .consequence("up is +Z, as Mitsuba 3 reads it, turned by \"to_world\""),
            );
        }
        let turbidity = props.float("turbidity", self.out.d).unwrap_or(3.0);
        let albedo = self.constant_color(props, "albedo", Rgb::splat(0.3), Role::Factor);
        let given = props.vector("sun_direction", self.out.d);
        let moment = self.moment(props);
        let sun_direction = match given.map(DVec3::try_normalize) {
            Some(Some(direction)) => world_from_light.transpose() * direction,
            Some(None) => {
                let message = "the direction of the sun cannot be zero";
                self.out.d.push(Diagnostic::error("mitsuba::bad-value", &node.span, message));
                return Vec::new();
            }
            None => moment.sun(),
        };
        if sun_direction.z < 0.0 {
            self.out.d.push(
                Diagnostic::warning("mitsuba::night", &node.span, "the sun is below the horizon")
                    .consequence("the model knows no night: this light is black"),
            );
        }
        let sky_scale = props.float("sky_scale", self.out.d).unwrap_or(1.0);
        let sun_scale = props.float("sun_scale", self.out.d).unwrap_or(1.0);
        let aperture = props.float("sun_aperture", self.out.d).unwrap_or(0.5358).to_radians();
        if let Some(true) = props.boolean("complex_sun", self.out.d) {
            self.out.d.push(
                Diagnostic::warning(
                    "mitsuba::unsupported-property",
                    &node.span,
                    "a sun darker at its edge is not supported",
                )
                .consequence("its disk has the same radiance all over it"),
            );
        }
        props.unsupported(&["stretch"], "the horizon is where it is", self.out.d);
        props.unsupported(&["sun_radius_scale"], "the sun has the size of \"sun_aperture\"", self.out.d);
        // Of tables and estimates that are not made here.
        props.ignore(&["resolution", "samples"]);
        let (world_from_light, sun_direction) =
            (world_from_light.as_mat3(), sun_direction.as_vec3().normalize_or_zero());
        let span = || node.span.clone();
        let sky = LightDesc::Sky {
            turbidity,
            albedo,
            sun_direction,
            scale: sky_scale,
            world_from_light,
            span: span(),
        };
        let sun = LightDesc::Sun {
            turbidity,
            direction: sun_direction,
            scale: sun_scale,
            aperture,
            world_from_light,
            span: span(),
        };
        match node.kind.as_str() {
            "sky" => vec![sky],
            "sun" => vec![sun],
            _ => vec![sky, sun],
        }
    }

    /// Date, time and place; the defaults are Mitsuba's: an afternoon in July in Tokyo.
    fn moment(&mut self, props: &mut Props<'a>) -> Moment {
        let mut number = |name, default: f64, possible: RangeInclusive<f64>| {
            let value = props.float(name, self.out.d).map_or(default, f64::from);
            self.in_range(name, value, possible, props.node)
        };
        let hour = number("hour", 15.0, 0.0..=24.0);
        let minute = number("minute", 0.0, 0.0..=60.0);
        let second = number("second", 0.0, 0.0..=60.0);
        let longitude = number("longitude", 139.6917, -360.0..=360.0);
        let latitude = number("latitude", 35.6894, -90.0..=90.0);
        let timezone = number("timezone", 9.0, -24.0..=24.0);
        let mut whole = |name, default: i64, possible: RangeInclusive<f64>| {
            let value = props.integer(name, self.out.d).unwrap_or(default);
            self.in_range(name, value as f64, possible, props.node) as i64
        };
        Moment {
            year: whole("year", 2010, -4000.0..=10_000.0),
            month: whole("month", 7, 1.0..=12.0),
            day: whole("day", 10, 1.0..=31.0),
            hour: hour + (minute + second / 60.0) / 60.0,
            longitude,
            latitude,
            timezone,
        }
    }

    /// The rotation in a transform of something infinitely far away, whose size does not matter; `None` after an error.
    pub(super) fn rotation_of(&mut self, to_world: glam::DMat4, what: &str, node: &Node) -> Option<DMat3> {
        let linear = DMat3::from_mat4(to_world);
        let columns = [linear.x_axis, linear.y_axis, linear.z_axis].map(DVec3::normalize_or_zero);
        let rotation = DMat3::from_cols(columns[0], columns[1], columns[2]);
        if super::analytic::is_orthonormal(rotation) {
            return Some(rotation);
        }
        let message = format!("the transform of {what} is more than a rotation and a scale");
        self.out.d.push(Diagnostic::error("mitsuba::bad-transform", &node.span, message));
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As Mitsuba 3.9.1 has it: the middle of the disk that its `sunsky` shows, to half a degree.
    #[test]
    fn the_sun_is_where_mitsuba_has_it() {
        let tokyo = Moment {
            year: 2010,
            month: 7,
            day: 10,
            hour: 15.0,
            longitude: 139.6917,
            latitude: 35.6894,
            timezone: 9.0,
        };
        let cape_town = Moment {
            year: 2020,
            month: 1,
            day: 15,
            hour: 11.5,
            longitude: 18.4,
            latitude: -33.9,
            timezone: 2.0,
        };
        for (moment, expected) in [
            (tokyo, DVec3::new(0.05146, 0.69245, 0.71963)),
            (cape_town, DVec3::new(-0.18425, -0.34017, 0.92213)),
        ] {
            assert!(moment.sun().angle_between(expected) < 0.01, "{} {expected}", moment.sun());
        }
    }

    #[test]
    fn noon_at_the_equator_at_the_equinox_is_overhead() {
        let moment = Moment {
            year: 2010,
            month: 3,
            day: 20,
            hour: 12.12,
            longitude: 0.0,
            latitude: 0.0,
            timezone: 0.0,
        };
        assert!(moment.sun().z > 0.9999, "{}", moment.sun());
    }
}
