"""One operation of Open3D on a file of points: peer_open3d.py normals|outliers|radius POINTS.ply OUT.ply [RADIUS]"""
import sys

import open3d

operation, points, out = sys.argv[1:4]
cloud = open3d.io.read_point_cloud(points)
if operation == "normals":
    cloud.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(17))  # the point itself is one
elif operation == "outliers":
    cloud, _ = cloud.remove_statistical_outlier(17, 3.0)
elif operation == "radius":
    cloud, _ = cloud.remove_radius_outlier(1, float(sys.argv[4]))
else:
    sys.exit("normals, outliers or radius")
open3d.io.write_point_cloud(out, cloud)
