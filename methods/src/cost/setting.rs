//! A place in the space of a method's knobs.

use super::knobs::{Knob, Range, swept};
use twinlight_core::directions::DirectionSet;

/// The methods, as they are written on the command line, and what they are.
pub const METHODS: [(&str, &str); 3] =
    [("reference", "path tracer"), ("slhb", "layered hit buffers"), ("voxel", "voxel cones")];

/// One value for every knob that its method is swept along.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Setting {
    method: &'static str,
    /// Index into [`Range::values`] per knob, in the order of the table.
    choices: Vec<usize>,
}

impl Setting {
    /// Where the sweep of a method begins.
    pub fn begin(method: &'static str) -> Self {
        Self::of(method, |range| index(range, range.begin))
    }

    /// The cheapest value of every knob.
    pub fn coarsest(method: &'static str) -> Self {
        Self::of(method, |_| 0)
    }

    /// The least biased value of every knob.
    pub fn finest(method: &'static str) -> Self {
        Self::of(method, |range| index(range, range.finest))
    }

    fn of(method: &'static str, choose: impl Fn(Range) -> usize) -> Self {
        Self { method, choices: swept(method).map(|(_, range)| choose(range)).collect() }.settled()
    }

    /// All settings of a method; `None` where there are more than `most`.
    pub fn all(method: &'static str, most: usize) -> Option<Vec<Self>> {
        let lengths: Vec<usize> = swept(method).map(|(_, range)| range.values.len()).collect();
        let count = lengths.iter().try_fold(1_usize, |count, &length| count.checked_mul(length))?;
        let setting = |mut number: usize| {
            let choices = lengths.iter().map(|&length| {
                let choice = number % length;
                number /= length;
                choice
            });
            Self { method, choices: choices.collect() }.settled()
        };
        (count <= most).then(|| (0..count).map(setting).collect())
    }

    /// The setting with these values, as [`Setting::flags`] gives them; `None` if the sweep has none like it.
    pub fn read<'a>(method: &str, flags: impl IntoIterator<Item = (&'a str, &'a str)>) -> Option<Self> {
        let (method, _) = METHODS.into_iter().find(|(name, _)| *name == method)?;
        let mut setting = Self::begin(method);
        for (flag, value) in flags {
            let (place, range) = place(method, flag)?;
            match range.values.iter().position(|other| *other == value) {
                Some(choice) => setting.choices[place] = choice,
                // Of a gather, a number that follows from the directions.
                None if flag == "--spp" => setting.choices[place] = 0,
                None => return None,
            }
        }
        Some(setting.settled())
    }

    /// As on the command line.
    pub fn method(&self) -> &'static str {
        self.method
    }

    /// The value of a knob; `None` if the method is not swept along it.
    pub fn value(&self, flag: &str) -> Option<&'static str> {
        let (place, range) = place(self.method, flag)?;
        range.values.get(self.choices[place]).copied()
    }

    /// Every knob with its value, in the order of the table.
    pub fn flags(&self) -> Vec<(&'static str, String)> {
        let values = swept(self.method).zip(&self.choices);
        values.map(|((knob, range), &choice)| (knob.flag, self.written(knob, range.values[choice]))).collect()
    }

    /// A gather takes a sample per direction, and no other number makes sense.
    fn written(&self, knob: &Knob, value: &str) -> String {
        match self.value("--directions").filter(|_| knob.flag == "--spp" && self.gathers()) {
            None => value.to_owned(),
            Some(set) => {
                let directions = set.parse::<DirectionSet>().map(|set| set.len().to_string());
                directions.unwrap_or_else(|_| unreachable!("the table's sets of directions are tested"))
            }
        }
    }

    fn gathers(&self) -> bool {
        self.value("--gather") == Some("all")
    }

    /// Of settings that mean the same, one.
    fn settled(mut self) -> Self {
        if self.gathers()
            && let Some((spp, _)) = place(self.method, "--spp")
        {
            self.choices[spp] = 0;
        }
        self
    }

    /// With another choice of one knob.
    fn with(&self, place: usize, choice: usize) -> Self {
        let mut other = self.clone();
        other.choices[place] = choice;
        if self.gathers() && !other.gathers() {
            // Samples count again: where the sweep begins, not at the fewest.
            let begin = Self::begin(self.method);
            swept(self.method)
                .enumerate()
                .filter(|(_, (knob, _))| knob.flag == "--spp")
                .for_each(|(spp, _)| other.choices[spp] = begin.choices[spp]);
        }
        other.settled()
    }

    /// Those with one knob one step away.
    pub fn neighbours(&self) -> Vec<Self> {
        let steps = |(place, (_, range)): (usize, (&Knob, Range))| {
            let choice = self.choices[place];
            let down = choice.checked_sub(1);
            let up = Some(choice + 1).filter(|&up| up < range.values.len());
            [up, down].into_iter().flatten().map(move |choice| self.with(place, choice))
        };
        let mut all: Vec<Self> = swept(self.method).enumerate().flat_map(steps).collect();
        all.retain(|other| other != self);
        all
    }

    /// Those with one knob at any other value: every option of each kernel beside each other. Of samples no more than tell noise from bias.
    pub fn star(&self) -> Vec<Self> {
        let values = |(place, (_, range)): (usize, (&Knob, Range))| {
            (0..=index(range, range.finest)).map(move |choice| self.with(place, choice))
        };
        let mut all: Vec<Self> = swept(self.method).enumerate().flat_map(values).collect();
        all.retain(|other| other != self);
        all
    }

    /// Whether nothing but the value of `flag` differs.
    pub fn differs_only_in(&self, other: &Self, flag: &str) -> bool {
        self.method == other.method
            && place(self.method, flag).is_some_and(|(place, _)| {
                let mut same = self.clone();
                same.choices[place] = other.choices[place];
                same == *other
            })
    }
}

fn index(range: Range, value: &str) -> usize {
    range.values.iter().position(|other| *other == value).unwrap_or(0)
}

/// Where a knob stands among those of a method's sweep.
fn place(method: &str, flag: &str) -> Option<(usize, Range)> {
    swept(method)
        .enumerate()
        .find(|(_, (knob, _))| knob.flag == flag)
        .map(|(place, (_, range))| (place, range))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(method: &str, flags: &[(&str, &str)]) -> Setting {
        Setting::read(method, flags.iter().copied()).unwrap()
    }

    #[test]
    fn settings_are_written_and_read_back() {
        for (method, _) in METHODS {
            let begin = Setting::begin(method);
            for setting in [Setting::coarsest(method), Setting::finest(method), begin.clone()]
                .into_iter()
                .chain(begin.star())
                .chain(Setting::coarsest(method).neighbours())
            {
                let flags = setting.flags();
                let flags = flags.iter().map(|(flag, value)| (*flag, value.as_str()));
                assert_eq!(Setting::read(method, flags), Some(setting.clone()), "{setting:?}");
            }
        }
        assert_eq!(Setting::read("photons", []), None);
        assert_eq!(Setting::read("voxel", [("--grid", "129")]), None);
        assert_eq!(Setting::read("voxel", [("--filter", "8")]), None);
    }

    #[test]
    fn neighbours_are_one_step_away() {
        let setting = read("voxel", &[("--grid", "256"), ("--cones", "6")]);
        let neighbours = setting.neighbours();
        // Up and down along samples, storage and light samples, down along the grid, up along cones.
        assert_eq!(neighbours.len(), 8);
        assert!(neighbours.contains(&read("voxel", &[("--grid", "128")])));
        assert!(!neighbours.contains(&read("voxel", &[("--grid", "64")])));
        let star = Setting::begin("reference").star();
        assert_eq!(
            star.iter().map(|setting| setting.value("--spp").unwrap()).collect::<Vec<_>>(),
            ["1", "4", "64"]
        );
    }

    /// A gather has one number of samples: settings that differ in it alone would be measured twice.
    #[test]
    fn gathers_have_a_sample_per_direction() {
        let gather = read("slhb", &[("--gather", "all"), ("--directions", "80"), ("--spp", "64")]);
        assert_eq!(gather, read("slhb", &[("--gather", "all"), ("--directions", "80"), ("--spp", "4")]));
        assert_eq!(gather.flags()[0], ("--spp", "80".to_owned()));
        assert!(gather.neighbours().iter().all(|other| *other != gather));
        assert!(gather.neighbours().contains(&read("slhb", &[("--directions", "80"), ("--spp", "16")])));
    }

    #[test]
    fn small_grids_are_complete() {
        assert_eq!(Setting::all("reference", 64).unwrap().len(), 5);
        let voxel = Setting::all("voxel", 1000).unwrap();
        assert_eq!(voxel.len(), 5 * 4 * 4 * 3 * 3);
        assert!((1..voxel.len()).all(|i| !voxel[..i].contains(&voxel[i])));
        assert_eq!(Setting::all("slhb", 1000), None);
    }

    #[test]
    fn one_flag_differs() {
        let (a, b) = (read("voxel", &[("--grid", "64")]), read("voxel", &[("--grid", "256")]));
        assert!(a.differs_only_in(&b, "--grid") && a.differs_only_in(&a, "--grid"));
        assert!(!a.differs_only_in(&b, "--cones") && !a.differs_only_in(&Setting::begin("slhb"), "--grid"));
    }
}
