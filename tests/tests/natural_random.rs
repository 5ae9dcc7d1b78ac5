//! Random problems given by their data: an answer is right, or says that it is not, or is refused.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use meshless_tests::natural::random::{Natural, judge, natural};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// Problems, unless `PROPTEST_CASES` says otherwise.
const CASES: u32 = 300;

/// How many of the worst are shown.
const SHOWN: usize = 10;

/// Share of the problems that must have an answer with an estimate: an answer that claims nothing is honest, but no use.
const ANSWERED: f64 = 0.3;

fn problems() -> Vec<Natural> {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(CASES);
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    (0..cases).map(|_| natural().new_tree(&mut runner).expect("a problem").current()).collect()
}

#[test]
fn no_answer_is_further_off_than_it_says() {
    let problems = problems();
    let (next, wrong, answered) = (AtomicUsize::new(0), Mutex::new(Vec::new()), AtomicUsize::new(0));
    let work = || {
        while let Some((number, problem)) = {
            let number = next.fetch_add(1, Ordering::Relaxed);
            problems.get(number).map(|problem| (number, problem))
        } {
            let verdict = meshless::on_threads(1, || judge(problem)).expect("a thread");
            if let Some(verdict) = verdict {
                answered.fetch_add(1, Ordering::Relaxed);
                if verdict.excess() > 1.0 {
                    wrong.lock().expect("no panic").push((number, verdict));
                }
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from).min(8) {
            scope.spawn(work);
        }
    });
    let mut wrong = wrong.into_inner().expect("no panic");
    wrong.sort_by(|a, b| b.1.excess().total_cmp(&a.1.excess()));
    let answered = answered.into_inner() as f64 / problems.len() as f64;
    for (number, verdict) in wrong.iter().take(SHOWN) {
        println!("# {number}: {verdict:?}\n{}", problems[*number].text(1.0));
    }
    assert!(wrong.is_empty(), "{} of {} answers are further off than they say", wrong.len(), problems.len());
    assert!(answered > ANSWERED, "{answered} of the problems have an answer with an estimate");
}
