# Mistakes in any step: exit 2, the step is shown, nothing is written.
binary_cloud cloud.ply 50
mkdir quiet && cp cloud.ply quiet && cd quiet
for words in '' ':' 'colour time :' ': colour time' 'colour tim' 'colour time : colur time' 'colour time : translate 1,2' \
  'info' 'translate 0,0,0' 'colour time extra' 'colour time --resolution 3'; do
  unchanged 2 raypipe cloud.ply $words 2>../err
  head -n 1 ../err
done
