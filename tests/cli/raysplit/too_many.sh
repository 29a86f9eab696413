# More clouds than anybody wants: one line, exit 1, nothing written.
{
  ply_header 100000 "${ray_properties[@]}"
  awk 'BEGIN { for (i = 0; i < 100000; ++i)
    print i, 0, 0, i, 0, 0, 2, i % 256, int(i / 256) % 256, int(i / 65536), 255 }'
} >cloud.ply
mkdir quiet && cp cloud.ply quiet && cd quiet
unchanged 1 raysplit cloud.ply colour 2>../err
cat ../err
unchanged 1 raysplit cloud.ply grid 0.00001,0,0 2>../err
cat ../err
