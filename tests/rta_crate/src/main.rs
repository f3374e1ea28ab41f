// SPDX-FileCopyrightText: Ravenchart contributors
// SPDX-License-Identifier: Apache-2.0

//! Response times of plain fixed-priority task sets, by the crate `response-time-analysis`.
//!
//! Reads one set a line, `period cost period cost ...`, most urgent task first. Writes one
//! line for each: the shortest time of the rounds in ns, then the response of every task, 0
//! where the crate finds none up to ten periods.

use std::io::{self, BufRead};
use std::time::Instant;

use response_time_analysis::arrival::Sporadic;
use response_time_analysis::demand::RBF;
use response_time_analysis::fixed_priority::fully_preemptive::dedicated_uniproc_rta;
use response_time_analysis::time::{Duration, Service};
use response_time_analysis::wcet::Scalar;

const ROUNDS: usize = 9;

fn responses(numbers: &[u64]) -> Vec<u64> {
    let tasks: Vec<_> = numbers
        .chunks_exact(2)
        .map(|task| {
            RBF::new(
                Sporadic::new_zero_jitter(Duration::from(task[0])),
                Scalar::new(Service::from(task[1])),
            )
        })
        .collect();
    (0..tasks.len())
        .map(|n| {
            let limit = Duration::from(10 * numbers[2 * n]);
            dedicated_uniproc_rta(&tasks[n], &tasks[..n], limit).map_or(0, u64::from)
        })
        .collect()
}

fn main() {
    for line in io::stdin().lock().lines() {
        let line = line.expect("standard input is text");
        let numbers: Vec<u64> =
            line.split_whitespace().map(|word| word.parse().expect("a number")).collect();
        let mut found = Vec::new();
        let spent = (0..ROUNDS)
            .map(|_| {
                let start = Instant::now();
                found = responses(&numbers);
                start.elapsed().as_nanos()
            })
            .min()
            .unwrap_or_default();
        let words: Vec<String> = found.iter().map(u64::to_string).collect();
        println!("{spent} {}", words.join(" "));
    }
}
