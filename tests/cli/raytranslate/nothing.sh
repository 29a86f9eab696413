# Moves by nothing leave every byte and the time of change alone.
binary_cloud cloud.ply 100
unchanged 0 rayrotate cloud.ply 0,0,0
unchanged 0 raytranslate cloud.ply 0,0,0
unchanged 0 raytranslate cloud.ply 0,0,0,0
