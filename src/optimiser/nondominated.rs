//! Order without weights between points with several scores: fronts and crowding of NSGA-II
//! (K. Deb et al., A Fast and Elitist Multiobjective Genetic Algorithm, IEEE Transactions on
//! Evolutionary Computation 6(2), 2002). All scores are maximised.

/// Whether `a` is no worse than `b` in any score and better in one.
pub fn dominates(a: &[f64], b: &[f64]) -> bool {
    let pairs = || a.iter().zip(b);
    pairs().all(|(a, b)| a >= b) && pairs().any(|(a, b)| a > b)
}

/// Rank of every point: 0 for those that no other dominates, 1 for those that only points of rank
/// 0 dominate, and so on.
pub fn ranks(points: &[Vec<f64>]) -> Vec<usize> {
    let mut ranks = vec![usize::MAX; points.len()];
    let mut left: Vec<usize> = (0..points.len()).collect();
    for rank in 0.. {
        if left.is_empty() {
            break;
        }
        let beaten = |&k: &usize| {
            left.iter()
                .any(|&other| dominates(&points[other], &points[k]))
        };
        let (rest, front): (Vec<usize>, Vec<usize>) = left.iter().partition(|k| beaten(k));
        for k in front {
            ranks[k] = rank;
        }
        left = rest;
    }
    ranks
}

/// Crowding distance of every point among those of its rank: how far apart its neighbours are,
/// summed over scores in shares of their range; infinite at the ends of a front.
pub fn crowding(points: &[Vec<f64>], ranks: &[usize]) -> Vec<f64> {
    let mut distance = vec![0.0; points.len()];
    let last = ranks.iter().copied().max().unwrap_or(0);
    let scores = points.first().map_or(0, Vec::len);
    for rank in 0..=last {
        for score in 0..scores {
            let mut front: Vec<usize> = (0..points.len()).filter(|&k| ranks[k] == rank).collect();
            front.sort_by(|&a, &b| points[a][score].total_cmp(&points[b][score]));
            let (Some(&low), Some(&high)) = (front.first(), front.last()) else {
                continue;
            };
            let range = points[high][score] - points[low][score];
            distance[low] = f64::INFINITY;
            distance[high] = f64::INFINITY;
            if range <= 0.0 {
                continue;
            }
            for window in front.windows(3) {
                distance[window[1]] +=
                    (points[window[2]][score] - points[window[0]][score]) / range;
            }
        }
    }
    distance
}

/// The indices of the `count` points that survive: lower ranks first, within the last rank the
/// least crowded; in the order of that choice.
pub fn survivors(points: &[Vec<f64>], count: usize) -> Vec<usize> {
    let ranks = ranks(points);
    let crowding = crowding(points, &ranks);
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| {
        let by_rank = ranks[a].cmp(&ranks[b]);
        by_rank.then(crowding[b].total_cmp(&crowding[a]))
    });
    order.truncate(count);
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(all: &[[f64; 2]]) -> Vec<Vec<f64>> {
        all.iter().map(|p| p.to_vec()).collect()
    }

    #[test]
    fn fronts_are_peeled_off_one_by_one() {
        let all = points(&[[1.0, 4.0], [2.0, 3.0], [1.0, 3.0], [0.5, 0.5], [2.0, 3.0]]);
        assert_eq!(ranks(&all), [0, 0, 1, 2, 0]);
        assert!(dominates(&[2.0, 3.0], &[1.0, 3.0]) && !dominates(&[2.0, 3.0], &[2.0, 3.0]));
    }

    #[test]
    fn ends_and_lonely_points_survive() {
        let all = points(&[[0.0, 4.0], [1.0, 3.0], [1.1, 2.9], [3.0, 1.0], [4.0, 0.0]]);
        let kept = survivors(&all, 3);
        assert!(kept.contains(&0) && kept.contains(&4) && kept.contains(&3));
    }

    #[test]
    fn odd_input_is_no_trouble() {
        assert!(survivors(&[], 3).is_empty());
        assert_eq!(survivors(&points(&[[1.0, 1.0]; 3]), 2).len(), 2);
    }
}
