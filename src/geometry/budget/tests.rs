use super::*;
use std::sync::Barrier;

fn limits(steps: u64, bytes: u64) -> Limits {
    Limits {
        steps,
        bytes,
        factor: 1.0,
    }
}

#[test]
fn work_within_the_budget_is_done() {
    let budget = Budget::new(limits(10, 100));
    assert_eq!(budget.run(|| spend("rounds", 10)), Ok(()));
    assert!(!budget.is_spent());
    // The next node begins anew, and both count for the build.
    assert_eq!(budget.run(|| make("points", 10, 10)), Ok(()));
    assert!(!budget.is_spent());
    assert_eq!(budget.run(|| spend("rounds", 1)), Ok(()));
    assert!(budget.is_spent());
    budget.begin(2);
    assert!(!budget.is_spent());
}

#[test]
fn work_that_is_given_up_unwinds_and_can_be_done_again() {
    let budget = Budget::new(limits(10, 100));
    let work = || budget.run(|| spend("rounds", 4));
    budget.stop().set();
    let unwound = catch_unwind(AssertUnwindSafe(work)).expect_err("it was to be given up");
    assert!(unwound.is::<GivenUp>());
    let apart = || budget.run(|| apart(|| spend("rounds", 4)));
    assert!(catch_unwind(AssertUnwindSafe(apart)).is_err());
    budget.stop().clear();
    assert_eq!(work(), Ok(()));
    assert!(!budget.is_spent());
}

#[test]
fn work_past_the_budget_ends_with_an_estimate() {
    let budget = Budget::new(limits(10, 100));
    let mut reached = false;
    let result = budget.run(|| {
        spend("rounds", 4);
        spend("rounds", 27);
        reached = true;
    });
    let (what, steps, limit) = ("rounds", 31, 10);
    let exceeded = Exceeded::Steps { what, steps, limit };
    assert_eq!(result, Err(exceeded.clone()));
    assert!(!reached);
    assert!(exceeded.help(budget.limits()).contains("`--budget 4`"));
    let result = budget.run(|| make("points", usize::MAX, 16));
    let message = result.unwrap_err().to_string();
    assert!(
        message.contains("GiB of memory, more than 0 MiB"),
        "{message}"
    );
    // A node counts for no more than it may use.
    assert!(!budget.is_spent());
}

#[test]
fn other_panics_pass() {
    let caught = catch_unwind(|| Budget::default().run(|| resume_unwind(Box::new("other"))));
    assert_eq!(caught.unwrap_err().downcast_ref::<&str>(), Some(&"other"));
}

#[test]
fn threads_charge_the_meter_that_is_carried_to_them() {
    let result = Budget::new(limits(10, 100)).run(|| {
        let meter = Meter::current();
        std::thread::scope(|scope| {
            let work = || {
                spend("nothing", 100);
                meter.during(|| spend("pieces", 6));
            };
            let threads = [scope.spawn(work), scope.spawn(work)];
            for thread in threads {
                thread.join().unwrap_or_else(|panic| resume_unwind(panic));
            }
        });
    });
    let (what, limit) = ("pieces", 10);
    assert_eq!(result, Err(Exceeded::More { what, limit }));
}

#[test]
fn what_is_apart_is_charged_to_nobody() {
    let budget = Budget::new(limits(10, 100));
    let node = || {
        spend("own", 6);
        apart(|| spend("shared", 9));
        spend("own", 4);
        apart(|| spend("shared", 11));
    };
    let message = budget.run(node).unwrap_err().to_string();
    assert!(message.contains("shared"), "{message}");
}

#[test]
fn without_a_meter_nothing_is_charged() {
    spend("rounds", u64::MAX);
    make("points", usize::MAX, usize::MAX);
    assert_eq!(factor(), 1.0);
}

#[test]
fn one_node_at_a_time_holds_large_things() {
    let (budget, both) = (Budget::new(limits(1000, 1000)), Barrier::new(2));
    let holding = AtomicU64::new(0);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                both.wait();
                let node = || {
                    make("points", 20, 10);
                    assert_eq!(holding.fetch_add(1, Ordering::SeqCst), 0);
                    std::thread::sleep(std::time::Duration::from_millis(20));
                    holding.fetch_sub(1, Ordering::SeqCst);
                    // A second thing of the same node does not wait for the first.
                    make("points", 20, 10);
                };
                assert_eq!(budget.run(node), Ok(()));
            });
        }
    });
}

#[test]
fn what_a_node_holds_is_added_up_by_kind() {
    let budget = Budget::new(limits(1000, 100));
    // Of one kind the most counts, whatever the order.
    let result = budget.run(|| {
        hold("points", 4, 10);
        hold("points", 6, 10);
        hold("points", 2, 10);
        hold("cells", 4, 10);
    });
    assert_eq!(result, Ok(()));
    let result = budget.run(|| {
        hold("points", 6, 10);
        hold("cells", 5, 10);
    });
    let exceeded = Exceeded::Together {
        what: "cells",
        bytes: Some(110),
        limit: 100,
    };
    assert_eq!(result, Err(exceeded));
    let result = budget.run(|| {
        hold("points", 6, 10);
        release("points");
        hold("cells", 10, 10);
    });
    assert_eq!(result, Ok(()));
}

#[test]
fn other_threads_do_not_say_how_much_is_held() {
    let result = Budget::new(limits(1000, 100)).run(|| {
        let meter = Meter::current();
        hold("points", 6, 10);
        std::thread::scope(|scope| {
            let work = || meter.during(|| hold("cells", 5, 10));
            let thread = scope.spawn(work);
            thread.join().unwrap_or_else(|panic| resume_unwind(panic));
        });
    });
    let message = result.unwrap_err().to_string();
    assert_eq!(
        message,
        "this needs more than 0 MiB of memory in all (cells)"
    );
}

#[test]
fn some_nodes_may_use_more_and_count_for_less() {
    let budget = Budget::new(limits(10, 100));
    let allowance = Allowance {
        steps: 20,
        bytes: 2,
    };
    let work = || make("voxels", 150, 1);
    assert_eq!(budget.run_allowing(allowance, work), Ok(()));
    assert_eq!(budget.run(|| spend("rounds", 10)), Ok(()));
    // 150 steps counted for 7: there is room for 3 more.
    assert_eq!(budget.run(|| spend("rounds", 3)), Ok(()));
    assert!(!budget.is_spent());
    assert_eq!(budget.run(|| spend("rounds", 1)), Ok(()));
    assert!(budget.is_spent());
}

#[test]
fn results_of_all_nodes_are_counted() {
    let budget = Budget::new(limits(10, 1 << 20));
    budget.keep(1 << 19);
    assert!(!budget.is_spent());
    budget.keep(1);
    assert!(budget.is_spent());
    assert!(budget.message().contains("results"), "{}", budget.message());
    budget.begin(1);
    assert!(!budget.is_spent());
}
