"""Self-motion manifolds of the KUKA iiwa 14: faultspace's tracer and ssik's closed-form charts.

Usage: see README.md beside this file.
"""

import json
import subprocess
import sys
import time

import numpy as np
from ssik import Manipulator

POSES = 100
POINTS_PER_CHART = 128
CHECKED_PER_CHART = 16
ROUNDS = 5
TURN = 2.0 * np.pi
AGREE = 1e-6


def chart_span(chart, joint):
    """Least and greatest angle of a joint on a chart over the whole circle, and its full turns."""
    t = np.linspace(-np.pi, np.pi, 513)
    angles = np.unwrap(chart.q(t)[:, joint])
    turns = round((angles[-1] - angles[0]) / TURN)
    ends = [extreme(chart, joint, t, sign * angles, sign) for sign in (-1.0, 1.0)]
    return ends, turns


def extreme(chart, joint, t, angles, sign):
    """Greatest of `angles` (sign times the joint's), refined three times around its place."""
    for _ in range(3):
        best = int(np.argmax(angles))
        here, value, step = t[best], angles[best], t[1] - t[0]
        t = np.linspace(here - step, here + step, 33)
        angles = np.unwrap(sign * chart.q(t)[:, joint])
        angles += TURN * np.round((value - angles[16]) / TURN)
    return sign * angles.max()


def union_measure(spans):
    """Measure of a union of arcs given by unwrapped ends."""
    if any(high - low >= TURN for low, high in spans):
        return TURN
    pieces = []
    for low, high in spans:
        start = (low + np.pi) % TURN
        end = start + (high - low)
        pieces += [(start, end)] if end <= TURN else [(start, TURN), (0.0, end - TURN)]
    measure, reached = 0.0, 0.0
    for low, high in sorted(pieces):
        measure += max(0.0, high - max(low, reached))
        reached = max(reached, high)
    return measure


def seconds(function):
    """The fastest of a few calls."""
    times = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return min(times)


def ask_ssik(arm, pose):
    """Charts with spans and points, and the times for charts alone and charts with points."""
    t = np.linspace(-np.pi, np.pi, POINTS_PER_CHART, endpoint=False)
    charts = arm.self_motion(pose).charts
    sampled = lambda: [chart.q(t) for chart in arm.self_motion(pose).charts]
    spans = [[chart_span(chart, joint) for joint in range(7)] for chart in charts]
    every = POINTS_PER_CHART // CHECKED_PER_CHART
    return {
        "spans": spans,
        "points": [chart.q(t[::every]) for chart in charts],
        "seconds": [seconds(lambda: arm.self_motion(pose).charts), seconds(sampled)],
    }


def ask_faultspace(program, robot, poses, answers):
    lines = ""
    for pose, answer in zip(poses, answers):
        points = np.concatenate(answer["points"]).tolist()
        lines += json.dumps({"pose": pose.tolist(), "points": points}) + "\n"
    run = subprocess.run([program, robot], input=lines, capture_output=True, text=True, check=True)
    return [json.loads(line) for line in run.stdout.splitlines()]


def compare(own, theirs):
    """Largest differences at one pose, or what does not match."""
    charts, curves = len(theirs["spans"]), len(own["spans"])
    placed = [point["curve"] for point in own["points"]]
    rows = [set(placed[k * CHECKED_PER_CHART :][:CHECKED_PER_CHART]) for k in range(charts)]
    if None in placed:
        return {"mismatch": f"{placed.count(None)} points of charts lie on no curve"}
    if charts != curves or any(len(row) != 1 for row in rows) or len(set.union(*rows)) != curves:
        return {"mismatch": f"{charts} charts, {curves} curves"}
    worst = 0.0
    for row, spans in zip(rows, theirs["spans"]):
        curve = row.pop()
        for joint, ((low, high), turns) in enumerate(spans):
            if abs(turns) != abs(own["windings"][curve][joint]):
                return {"mismatch": "other windings"}
            if turns == 0:
                first, last = own["spans"][curve][joint]
                gaps = [first - low, last - high]
                worst = max(worst, *(abs(gap - TURN * round(gap / TURN)) for gap in gaps))
    arcs = lambda joint: [
        (0.0, TURN) if turns else ends for ends, turns in (row[joint] for row in theirs["spans"])
    ]
    measures = [union_measure(arcs(joint)) for joint in range(7)]
    return {
        "ends": worst,
        "measures": np.abs(np.array(measures) - own["measures"]).max(),
        "points": max(point["distance"] for point in own["points"]),
    }


def main():
    program, robot = sys.argv[1:3]
    arm = Manipulator.from_prebuilt("iiwa14")
    rng = np.random.default_rng(1)
    poses = [arm.fk(q) for q in rng.uniform(-np.pi, np.pi, (POSES, 7))]
    theirs = [ask_ssik(arm, pose) for pose in poses]
    own = ask_faultspace(program, robot, poses, theirs)
    found = [compare(a, b) for a, b in zip(own, theirs)]
    for number, pose in enumerate(found):
        if "mismatch" in pose:
            kind = own[number]["completeness"]
            print(f"pose {number}: {pose['mismatch']} (completeness: {kind})")
    good = [pose for pose in found if "mismatch" not in pose]
    worst = lambda key: max((pose[key] for pose in good), default=float("nan"))
    print(f"poses with the same curves                       {len(good)} of {POSES}")
    print(f"curves of all poses                              {sum(len(a['spans']) for a in own)}")
    print(f"charts of all poses                              {sum(len(b['spans']) for b in theirs)}")
    print(f"largest distance of a chart's point to a curve   {worst('points'):.1e} rad")
    print(f"largest difference of an end of a joint's range  {worst('ends'):.1e} rad")
    print(f"largest difference of the size of a union        {worst('measures'):.1e} rad")
    charts, sampled = (1e3 * np.median([b["seconds"][k] for b in theirs]) for k in range(2))
    fine, coarse = (
        1e3 * np.median([a["seconds"][key] for a in own]) for key in ("default", "coarse")
    )
    print("median time per pose, one core")
    print(f"  ssik, charts alone                             {charts:.3f} ms")
    print(f"  ssik, charts and {POINTS_PER_CHART} points on each            {sampled:.3f} ms")
    print(f"  faultspace, settings for single poses          {fine:.3f} ms")
    print(f"  faultspace, settings of atlases                {coarse:.3f} ms")
    print(f"time ratio faultspace (single poses) / ssik (with points)  {fine / sampled:.2f}")
    print(f"time ratio faultspace (atlases) / ssik (with points)       {coarse / sampled:.2f}")
    if len(good) < POSES or worst("points") > AGREE:
        sys.exit("the sets differ")


if __name__ == "__main__":
    main()
