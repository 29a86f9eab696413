# A fourth number moves the times.
make_cloud cloud.ply 3
raytranslate -q cloud.ply 0,0,0,-1000
rayexport -q cloud.ply out.csv - && cut -d, -f4 out.csv | awk "NR > 1 { printf \"%.6f\\n\", \$1 }"
