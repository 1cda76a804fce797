//! Writes each kind of noise, the water bed and a ten-second mix as WAV files to a folder, and
//! prints their levels: `cargo run --release -p bioscope_acoustics --example sound_kinds -- FOLDER`.

use std::path::Path;
use std::time::Instant;

use bioscope_acoustics::synthesis::{KINDS, Kind, synthesize, water_bed::WaterBed};
use bioscope_acoustics::{ListenerPath, ListenerPose, Medium, SoundTrack};
use bioscope_core::{NOTHING, Purpose, Quat, Random, SoundEvent, Vec3};

const RATE: u32 = 48_000;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "sounds".to_owned());
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    for kind in &KINDS {
        let event = event(kind, 1, 0.0, Vec3::ZERO);
        let clip = synthesize(&event, 7, RATE);
        let frames: Vec<[f32; 2]> = clip.iter().map(|&sample| [0.8 * sample; 2]).collect();
        report(kind.word, &frames);
        write(&folder.join(format!("{}.wav", kind.word)), &frames)?;
    }
    let mut bed = vec![[0.0; 2]; 10 * RATE as usize];
    WaterBed::new(7, RATE).add(Medium::WATER.bed, 0, &mut bed);
    report("water_bed", &bed);
    write(&folder.join("water_bed.wav"), &bed)?;
    let mix = reef(600)?;
    report("mix", &mix);
    write(&folder.join("mix.wav"), &mix)?;
    Ok(())
}

fn event(kind: &Kind, source: u32, time: f64, position: Vec3) -> SoundEvent {
    SoundEvent {
        source,
        kind: kind.word.into(),
        time,
        duration: 0.0,
        position,
        velocity: Vec3::ZERO,
        amplitude: kind.amplitude,
        pitch: 0.0,
    }
}

/// Ten seconds of a busy reef round a turning listener.
fn reef(count: u32) -> Result<Vec<[f32; 2]>, Box<dyn std::error::Error>> {
    let mut random = Random::new(7, NOTHING, 0, Purpose::new("example"));
    let events: Vec<SoundEvent> = (0..count)
        .map(|source| {
            let kind = &KINDS[random.below(KINDS.len() as u32 - 1) as usize];
            let place = random.direction() * random.range(2.0, 20.0);
            event(kind, source, f64::from(random.range(0.0, 10.0)), place)
        })
        .collect();
    let pose = |time: f64| ListenerPose {
        time,
        position: Vec3::new(0.0, 0.0, -0.5 * time as f32),
        rotation: Quat::from_rotation_y(0.2 * time as f32),
    };
    let mut listener = ListenerPath::starting(pose(0.0))?;
    (1..=300).try_for_each(|frame| listener.push(pose(f64::from(frame) / 30.0)))?;
    let mut track = SoundTrack::new(RATE, 7, Medium::WATER)?;
    let begin = Instant::now();
    track.add(&events)?;
    let frames = track.render(&listener, 0.0, 10 * RATE as usize)?;
    println!("{count} events, 10 s rendered in {:.3} s", begin.elapsed().as_secs_f64());
    Ok(frames)
}

fn report(name: &str, frames: &[[f32; 2]]) {
    let decibels = |level: f32| 20.0 * level.max(1e-9).log10();
    let peak = frames.iter().flatten().fold(0.0, |top: f32, sample| top.max(sample.abs()));
    let square: f32 = frames.iter().flatten().map(|sample| sample * sample).sum();
    let level = (square / (2 * frames.len()) as f32).sqrt();
    println!(
        "{name:<10} {:6.3} s  peak {:6.1} dBFS  rms {:6.1} dBFS  crest {:5.1} dB",
        frames.len() as f32 / RATE as f32,
        decibels(peak),
        decibels(level),
        decibels(peak / level)
    );
}

/// Writes 16-bit stereo PCM.
fn write(path: &Path, frames: &[[f32; 2]]) -> std::io::Result<()> {
    let size = 4 * frames.len() as u32;
    let mut bytes = Vec::with_capacity(44 + size as usize);
    bytes.extend(b"RIFF");
    bytes.extend((36 + size).to_le_bytes());
    bytes.extend(b"WAVEfmt ");
    bytes.extend(16u32.to_le_bytes());
    for word in [1u16, 2] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend(RATE.to_le_bytes());
    bytes.extend((4 * RATE).to_le_bytes());
    for word in [4u16, 16] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend(b"data");
    bytes.extend(size.to_le_bytes());
    for sample in frames.iter().flatten() {
        bytes.extend(((sample.clamp(-1.0, 1.0) * 32_767.0) as i16).to_le_bytes());
    }
    std::fs::write(path, bytes)
}
