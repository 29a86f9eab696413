"""Open3D's and PCL's global registration and ICP on the pairs that bench_accuracy alignment left in a folder:
peer_registration.py PAIRS_FOLDER VOXEL [PCL_PROGRAM]. Prints a Markdown table, ours beside them.

Both down-sample to VOXEL (m), take normals within 2 and features (FPFH) within 5 of it, and match within 1.5, as
Open3D's tutorial has it; then ICP, point to plane, on points of 5 cm, within 2 voxels first and 10 cm last."""
import math
import pathlib
import subprocess
import sys
import time

import numpy
import open3d

registration = open3d.pipelines.registration
folder, voxel = pathlib.Path(sys.argv[1]), float(sys.argv[2])
pcl = sys.argv[3] if len(sys.argv) > 3 and pathlib.Path(sys.argv[3]).exists() else None
FINE_VOXEL, LAST_DISTANCE = 0.05, 0.1
COARSE, FINE = (0.5, 0.2), (0.05, 0.02)  # degrees, m
PROGRAMS = ["ours", "Open3D RANSAC", "Open3D fast global"] + (["PCL prerejective"] if pcl else [])


def near(radius, most):
    return open3d.geometry.KDTreeSearchParamHybrid(radius=radius, max_nn=most)


def prepared(name):
    """Points for features, the features, and points for ICP."""
    points = open3d.io.read_point_cloud(name)
    sparse, fine = points.voxel_down_sample(voxel), points.voxel_down_sample(FINE_VOXEL)
    sparse.estimate_normals(near(2 * voxel, 30))
    fine.estimate_normals(near(4 * FINE_VOXEL, 30))
    return sparse, registration.compute_fpfh_feature(sparse, near(5 * voxel, 100)), fine


def ransac(a, b):
    distance = 1.5 * voxel
    checks = [registration.CorrespondenceCheckerBasedOnEdgeLength(0.9),
              registration.CorrespondenceCheckerBasedOnDistance(distance)]
    return registration.registration_ransac_based_on_feature_matching(
        a[0], b[0], a[1], b[1], True, distance, registration.TransformationEstimationPointToPoint(False), 3, checks,
        registration.RANSACConvergenceCriteria(1000000, 0.999)).transformation


def fast_global(a, b):
    return registration.registration_fgr_based_on_feature_matching(
        a[0], b[0], a[1], b[1],
        registration.FastGlobalRegistrationOption(maximum_correspondence_distance=0.5 * voxel)).transformation


def icp(a, b, pose):
    for distance in (2 * voxel, LAST_DISTANCE):
        pose = registration.registration_icp(a[2], b[2], distance, pose,
                                             registration.TransformationEstimationPointToPlane()).transformation
    return pose


def numbers(line):
    return [float(word) for word in line.split()]


def matrix(values):
    return numpy.vstack([numpy.array(values).reshape(3, 4), [0, 0, 0, 1]])


def error(pose, truth, middle):
    cosine = (numpy.trace(pose[:3, :3].T @ truth[:3, :3]) - 1) / 2
    at = numpy.append(middle, 1)
    return math.degrees(math.acos(max(-1, min(1, cosine)))), float(numpy.linalg.norm((pose - truth) @ at))


def by_open3d(name, search):
    begin = time.time()
    a, b = prepared(f"{name}_cloud.ply"), prepared(f"{name}_reference.ply")
    return icp(a, b, search(a, b)), time.time() - begin


def by_pcl(name):
    begin = time.time()
    try:
        out = subprocess.run([pcl, f"{name}_cloud.ply", f"{name}_reference.ply", str(voxel)], check=True,
                             capture_output=True, text=True, timeout=300).stdout
        return matrix(numbers(out)), time.time() - begin
    except (subprocess.SubprocessError, ValueError):
        return numpy.eye(4), time.time() - begin


def results(pair):
    """For each program: pose (none where it refuses), seconds."""
    name = str(pair.with_suffix(""))
    truth, found, rest = (numbers(line) for line in pair.read_text().splitlines())
    yield "ours", matrix(found) if rest[1] else None, rest[0], truth, rest[2:]
    for program, run in [("Open3D RANSAC", lambda: by_open3d(name, ransac)),
                         ("Open3D fast global", lambda: by_open3d(name, fast_global)),
                         ("PCL prerejective", lambda: by_pcl(name))]:
        if program in PROGRAMS:
            yield (program, *run(), truth, rest[2:])


rows = {}
for pair in sorted(folder.glob("*.txt")):
    row = rows.setdefault(pair.stem.rsplit(":", 1)[0], {})
    for program, pose, seconds, truth, middle in results(pair):
        tally = row.setdefault(program, [0, 0, 0, 0, 0.0])
        tally[0] += 1
        tally[4] += seconds
        if pose is None:
            continue
        turn, shift = error(pose, matrix(truth), middle)
        coarse, fine = (turn < limit[0] and shift < limit[1] for limit in (COARSE, FINE))
        tally[1] += fine
        tally[2] += coarse
        tally[3] += not coarse
        print(pair.stem, program, f"{turn:.3f} degrees, {shift:.3f} m, {seconds:.1f} s", file=sys.stderr)
print(f"\nOther programs on the same pairs, features on {voxel} m. Of the pairs: % within 0.05 degrees and 2 cm / within "
      "0.5 degrees and 0.2 m / wrong, and seconds. Only ours says when it is not sure.\n")
print("| world: overlap, % | pairs |", " | ".join(PROGRAMS), "|")
print("|---|---|" + "---|" * len(PROGRAMS))
for name, row in rows.items():
    cells = [" / ".join(f"{100 * part / tally[0]:.0f}" for part in tally[1:4]) + f", {tally[4] / tally[0]:.1f} s"
             for tally in (row[program] for program in PROGRAMS)]
    print("|", name, "|", row["ours"][0], "|", " | ".join(cells), "|")
