"""Forward kinematics and Jacobian of a 7R robot: values and times of faultspace and Pinocchio.

The robot is the 7R of Bader & Maciejewski (2021). Usage: see README.md beside this file.
"""

import json
import subprocess
import sys
import timeit

import numpy as np
import pinocchio as pin

# Standard Denavit-Hartenberg rows: twist (deg), length (m), offset (m).
ROWS = [
    (-98, 0.17, 0.0),
    (-114, 1.42, 1.67),
    (-66, 1.42, -0.69),
    (50, 0.56, -1.77),
    (-92, 1.32, 2.42),
    (-93, 1.27, -0.38),
    (0, 1.0, 0.95),
]
CONFIGURATIONS = 1000
AGREE = 1e-12


def pinocchio_model():
    """The robot as a Pinocchio model, with the frame number of its tool."""
    model, before = pin.Model(), pin.SE3.Identity()
    for number, (alpha, a, d) in enumerate(ROWS, 1):
        model.addJoint(number - 1, pin.JointModelRZ(), before, f"joint_{number}")
        turn = pin.utils.rotate("x", np.deg2rad(alpha))
        before = pin.SE3(turn, np.array([a, 0.0, d]))
    tool = pin.Frame("tool", 7, 0, before, pin.FrameType.OP_FRAME)
    return model, model.addFrame(tool)


def per_call(function, number=20000, rounds=15):
    """Seconds per call, the fastest of several rounds."""
    return min(timeit.repeat(function, number=number, repeat=rounds)) / number


def pinocchio_times(model, configurations):
    """Seconds per call as seen from Python, and without the cost of calling from Python.

    A call on a model without joints, with the same arguments, has the cost of the binding and of
    almost nothing else.
    """
    data, q = model.createData(), configurations[0]
    empty = pin.Model()
    empty_data, empty_q = empty.createData(), np.zeros(0)
    seen = per_call(lambda: pin.computeJointJacobians(model, data, q))
    overhead = per_call(lambda: pin.computeJointJacobians(empty, empty_data, empty_q))
    return seen, overhead


def faultspace_answers(program, robot, configurations):
    lines = "".join(json.dumps(list(q)) + "\n" for q in configurations)
    run = subprocess.run([program, robot], input=lines, capture_output=True, text=True, check=True)
    answers = [json.loads(line) for line in run.stdout.splitlines()]
    return answers[:-1], answers[-1]["seconds"]


def largest_differences(model, tool, configurations, answers):
    """Of tool poses (m and entries of rotations) and of Jacobians."""
    data, pose, jacobian = model.createData(), 0.0, 0.0
    for q, answer in zip(configurations, answers):
        pin.computeJointJacobians(model, data, q)
        pin.updateFramePlacements(model, data)
        at_tool = pin.getFrameJacobian(model, data, tool, pin.LOCAL_WORLD_ALIGNED)
        pose = max(pose, np.abs(data.oMf[tool].homogeneous - np.array(answer["pose"])).max())
        jacobian = max(jacobian, np.abs(at_tool - np.array(answer["jacobian"])).max())
    return pose, jacobian


def main():
    program, robot = sys.argv[1:3]
    model, tool = pinocchio_model()
    rng = np.random.default_rng(1)
    configurations = rng.uniform(-np.pi, np.pi, (CONFIGURATIONS, 7))
    answers, own = faultspace_answers(program, robot, configurations)
    pose, jacobian = largest_differences(model, tool, configurations, answers)
    seen, overhead = pinocchio_times(model, configurations)
    net = seen - overhead
    print(f"configurations                              {CONFIGURATIONS}")
    print(f"largest difference of tool poses            {pose:.1e}")
    print(f"largest difference of Jacobians             {jacobian:.1e}")
    print(f"Pinocchio {pin.__version__}, called from Python          {1e6 * seen:.3f} us")
    print(f"  an empty model, called from Python        {1e6 * overhead:.3f} us")
    print(f"  difference: forward kinematics, Jacobian  {1e6 * net:.3f} us")
    print(f"faultspace, Kernel::linearise               {1e6 * own:.3f} us")
    print(f"time ratio faultspace / Pinocchio           {own / net:.2f}")
    if max(pose, jacobian) > AGREE:
        sys.exit(f"the values differ by more than {AGREE:.0e}")


if __name__ == "__main__":
    main()
