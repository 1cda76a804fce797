//! Environments that are programs of their own, at the other end of a pipe.

use std::{
    io::{Read, Write},
    process::{Child, ChildStdin, Command, Stdio},
    sync::mpsc::{self, Receiver, RecvTimeoutError},
    time::{Duration, Instant},
};

use super::{Environment, EnvironmentError, Reply, Request};

/// The address that ends a transmission.
const END: u32 = u32::MAX;
/// Numbers about the turtle that follow the parameters of a message: place, heading, left, up and width.
const ABOUT: usize = 13;
/// Most parameters of one answer.
const WIDEST: u32 = 256;

/// A foreign process that answers on its standard output what it is asked on its standard input.
///
/// A transmission is `u32 count, u32 stride`, then per message a `u32` address and `stride`
/// little-endian `f32`, then the address 0xFFFFFFFF. A message to the process holds the number of its
/// parameters, so many parameters as the longest message has, and where the turtle is, its
/// heading, left, up and the width. An answer holds new parameters; addresses without an answer keep theirs.
///
/// A process that dies, answers nonsense or does not answer in time ends the derivation.
/// Source of the layout: R. Měch and P. Prusinkiewicz, SIGGRAPH 1996, section 4, which leaves it open.
pub struct Pipe {
    name: String,
    child: Child,
    input: Option<ChildStdin>,
    answers: Receiver<Vec<u8>>,
    received: Vec<u8>,
    patience: Duration,
}

impl Pipe {
    /// Starts a program. It is run as it is, without a shell.
    pub fn start(command: &[String], patience: Duration) -> Result<Self, EnvironmentError> {
        let Some((program, arguments)) = command.split_first() else {
            return Err(EnvironmentError::Refused {
                name: "pipe".into(),
                reason: "expected a command".into(),
            });
        };
        let gone = |error: std::io::Error| EnvironmentError::Gone {
            name: program.clone(),
            reason: error.to_string(),
        };
        let mut process = Command::new(program);
        process.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = process.spawn().map_err(gone)?;
        let input = child.stdin.take();
        let output = child.stdout.take();
        let (sender, answers) = mpsc::sync_channel(64);
        std::thread::spawn(move || {
            let Some(mut output) = output else { return };
            let mut buffer = vec![0; 1 << 16];
            while let Ok(count @ 1..) = output.read(&mut buffer) {
                if sender.send(buffer[..count].to_vec()).is_err() {
                    return;
                }
            }
        });
        let name = program.clone();
        Ok(Self { name, child, input, answers, received: Vec::new(), patience })
    }

    fn gone(&self, reason: impl Into<String>) -> EnvironmentError {
        EnvironmentError::Gone { name: self.name.clone(), reason: reason.into() }
    }

    fn nonsense(&self, reason: impl Into<String>) -> EnvironmentError {
        EnvironmentError::Nonsense { name: self.name.clone(), reason: reason.into() }
    }

    /// Sends a transmission, from a thread so that a process that does not read stops nobody.
    fn send(&mut self, bytes: Vec<u8>, end: Instant) -> Result<(), EnvironmentError> {
        let Some(mut input) = self.input.take() else {
            return Err(self.gone("it has no standard input"));
        };
        let (sender, sent) = mpsc::channel();
        std::thread::spawn(move || {
            let result = input.write_all(&bytes).and_then(|()| input.flush());
            // Nobody waits any more if the time is over.
            let _ = sender.send((input, result));
        });
        match sent.recv_timeout(end.saturating_duration_since(Instant::now())) {
            Ok((input, Ok(()))) => {
                self.input = Some(input);
                Ok(())
            }
            Ok((_, Err(error))) => Err(self.gone(error.to_string())),
            Err(_) => Err(self.gone("it does not read what it is asked")),
        }
    }

    /// The next bytes of the answer.
    fn take(&mut self, count: usize, end: Instant) -> Result<Vec<u8>, EnvironmentError> {
        while self.received.len() < count {
            match self.answers.recv_timeout(end.saturating_duration_since(Instant::now())) {
                Ok(bytes) => self.received.extend(bytes),
                Err(RecvTimeoutError::Timeout) => {
                    let seconds = self.patience.as_secs_f32();
                    return Err(self.gone(format!("it has not answered for {seconds} s")));
                }
                Err(RecvTimeoutError::Disconnected) => {
                    let status = self.child.try_wait();
                    let told = match status {
                        Ok(Some(status)) => format!("it has ended ({status})"),
                        _ => "it has closed its standard output".into(),
                    };
                    return Err(self.gone(told));
                }
            }
        }
        let rest = self.received.split_off(count);
        Ok(std::mem::replace(&mut self.received, rest))
    }

    fn word(&mut self, end: Instant) -> Result<u32, EnvironmentError> {
        let bytes = self.take(4, end)?;
        Ok(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
    }
}

/// One transmission with all messages of a step.
fn transmission(requests: &[Request]) -> Vec<u8> {
    let widest = requests.iter().map(|request| request.parameters.len()).max().unwrap_or(0);
    let stride = 1 + widest + ABOUT;
    let mut bytes = Vec::with_capacity(12 + requests.len() * 4 * (stride + 1));
    let word = |bytes: &mut Vec<u8>, word: u32| bytes.extend(word.to_le_bytes());
    word(&mut bytes, requests.len() as u32);
    word(&mut bytes, stride as u32);
    for request in requests {
        word(&mut bytes, request.module as u32);
        let count = request.parameters.len();
        let own = request.parameters.iter().copied();
        let padded = own.chain(std::iter::repeat_n(0.0, widest - count));
        let axes = [request.position, request.heading, request.left, request.up];
        let about = axes.iter().flat_map(|axis| axis.to_array()).chain([request.width]);
        for number in std::iter::once(count as f32).chain(padded).chain(about) {
            bytes.extend(number.to_le_bytes());
        }
    }
    word(&mut bytes, END);
    bytes
}

impl Environment for Pipe {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        let end = Instant::now() + self.patience;
        self.send(transmission(requests), end)?;
        let (count, stride) = (self.word(end)?, self.word(end)?);
        if count as usize > requests.len() || stride > WIDEST {
            let told =
                format!("{count} answers of {stride} numbers to {} questions", requests.len());
            return Err(self.nonsense(told));
        }
        for _ in 0..count {
            let address = self.word(end)? as usize;
            let bytes = self.take(4 * stride as usize, end)?;
            let Ok(number) = requests.binary_search_by(|one| one.module.cmp(&address)) else {
                return Err(
                    self.nonsense(format!("an answer to module {address}, which did not ask"))
                );
            };
            let values = bytes.chunks_exact(4);
            for (own, value) in replies[number].parameters.iter_mut().zip(values) {
                *own = f32::from_le_bytes([value[0], value[1], value[2], value[3]]);
            }
        }
        let last = self.word(end)?;
        if last == END { Ok(()) } else { Err(self.nonsense("more answers than it announced")) }
    }
}

impl Drop for Pipe {
    fn drop(&mut self) {
        // It ends at the end of its input; what does not is ended. Both may have happened already.
        self.input = None;
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[cfg(test)]
mod tests {
    use bioscope_core::Vec3;

    use super::*;

    fn shell(script: &str, seconds: f32) -> Pipe {
        let command = ["sh", "-c", script].map(str::to_owned);
        Pipe::start(&command, Duration::from_secs_f32(seconds)).unwrap()
    }

    fn trouble(script: &str, seconds: f32) -> String {
        let mut pipe = shell(script, seconds);
        let question = Request {
            module: 3,
            id: 3,
            parameters: &[1.0],
            position: Vec3::ZERO,
            heading: Vec3::Y,
            left: Vec3::NEG_X,
            up: Vec3::Z,
            width: 1.0,
            color: 1,
            following: None,
        };
        let mut answer = [1.0];
        let mut replies = [Reply { parameters: &mut answer }];
        pipe.exchange(0, &[question], &mut replies).unwrap_err().to_string()
    }

    #[test]
    fn processes_that_die_hang_or_babble_are_told() {
        assert!(trouble("exit 3", 5.0).contains("the environment sh is gone"));
        let silent = trouble("sleep 20", 0.3);
        assert!(silent.contains("has not answered for 0.3 s"), "{silent}");
        let babble = trouble("yes", 5.0);
        assert!(babble.contains("answered nonsense"), "{babble}");
        let command = ["/no/such/program".to_owned()];
        let missing = Pipe::start(&command, Duration::from_secs(1)).err().unwrap().to_string();
        assert!(missing.contains("/no/such/program"), "{missing}");
    }
}
