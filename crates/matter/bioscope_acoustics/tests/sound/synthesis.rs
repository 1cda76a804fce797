use bioscope_acoustics::synthesis::{KINDS, kind, synthesize, water_bed::WaterBed};
use bioscope_core::{SoundEvent, Vec3};

use crate::measure::*;

fn clip(word: &'static str, change: impl Fn(&mut SoundEvent)) -> Vec<f32> {
    let mut event = event(word, 1.5, Vec3::ZERO);
    change(&mut event);
    synthesize(&event, 7, RATE)
}

#[test]
fn every_kind_sounds_and_ends_in_silence() {
    for kind in &KINDS {
        for (pitch, duration) in [(0.0, 0.0), (20.0, 0.001), (1e6, 100.0), (500.0, 0.4)] {
            let samples =
                clip(kind.word, |event| (event.pitch, event.duration) = (pitch, duration));
            let name = format!("{} at {pitch} Hz for {duration} s", kind.word);
            assert!(samples.iter().all(|sample| sample.is_finite()), "{name}");
            assert!(samples.iter().all(|sample| *sample == 0.0 || sample.is_normal()), "{name}");
            assert!(rms(&samples) > 1e-3, "{name}: {}", rms(&samples));
            assert!(samples.len() as f32 <= kind.longest * RATE as f32, "{name}");
            let top = samples.iter().fold(0.0, |top: f32, sample| top.max(sample.abs()));
            assert!((top - 1.0).abs() < 1e-5, "{name}: {top}");
            assert!(samples[samples.len() - 1].abs() < 1e-3, "{name}");
            let mean = samples.iter().sum::<f32>() / samples.len() as f32;
            assert!(mean.abs() < 0.02, "{name}: mean {mean}");
        }
    }
}

#[test]
fn every_kind_has_its_color() {
    let ranges = [
        ("bubble", 800.0, 1_300.0),
        ("bite", 500.0, 2_600.0),
        ("splash", 500.0, 3_000.0),
        ("crackle", 2_500.0, 8_000.0),
        ("swish", 120.0, 450.0),
        ("rasp", 1_800.0, 3_800.0),
        ("tone", 400.0, 450.0),
    ];
    assert_eq!(ranges.len(), KINDS.len());
    for (word, low, high) in ranges {
        let middle = middle_frequency(&clip(word, |_| ()));
        assert!((low..=high).contains(&middle), "{word}: {middle} Hz");
    }
}

#[test]
fn pitch_of_a_bubble_rises() {
    let samples = clip("bubble", |_| ());
    let early = frequency(&samples[200..1_200]);
    let late = frequency(&samples[1_800..2_800]);
    assert!(late > 1.05 * early, "{early} {late}");
}

#[test]
fn noises_differ_between_times_sources_and_seeds_and_repeat_otherwise() {
    for word in ["bite", "splash", "crackle", "swish", "rasp"] {
        let base = clip(word, |_| ());
        assert_eq!(base, clip(word, |_| ()));
        assert_ne!(base, clip(word, |event| event.time = 3.0));
        assert_ne!(base, clip(word, |event| event.source = 6));
        assert_ne!(base, synthesize(&event(word, 1.5, Vec3::ZERO), 8, RATE));
    }
}

#[test]
fn a_word_that_is_not_known_gives_a_click() {
    assert!(kind("quack").is_none());
    let samples = clip("quack", |_| ());
    assert!(rms(&samples) > 0.01 && samples.len() < 4_800);
}

#[test]
fn the_water_bed_is_level_wide_seamless_and_starts_anywhere() {
    let whole = {
        let mut frames = vec![[0.0; 2]; 20 * RATE as usize];
        WaterBed::new(3, RATE).add(0.03, 0, &mut frames);
        frames
    };
    let (left, right) = (side(&whole, 0), side(&whole, 1));
    for level in [rms(&left), rms(&right)] {
        assert!((0.025..0.036).contains(&level), "{level}");
    }
    let product: f64 = left.iter().zip(&right).map(|(l, r)| f64::from(l * r)).sum();
    let correlation = product / left.len() as f64 / f64::from(rms(&left) * rms(&right));
    assert!((0.0..0.4).contains(&correlation), "{correlation}");
    assert!(largest_step(&whole) < 0.03, "{}", largest_step(&whole));

    let from = 7 * RATE as usize + 123;
    let mut part = vec![[0.0; 2]; 5_000];
    WaterBed::new(3, RATE).add(0.03, from as i64, &mut part);
    assert_eq!(part, whole[from..from + 5_000]);
}
