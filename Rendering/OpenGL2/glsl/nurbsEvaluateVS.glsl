//VTK::System::Dec

// A rectangle of the target for each tile: the samples that are to be evaluated.

//NURBS::Tile::Dec

uniform isamplerBuffer nurbsJobs; // index of the tile, x and y of its rows in the buffer between passes
uniform int firstJob;
uniform vec2 targetSize;

flat out ivec4 tilePlaceLog;   // place in the target, log
flat out ivec4 tileFirstRows;  // first cell, place of the rows
flat out ivec4 tileBlockPoint; // blocks of knots, first control point, stride

void main()
{
  ivec4 job = texelFetch(nurbsJobs, firstJob + gl_InstanceID);
  nurbsTileInfo tile = nurbsGetTile(job.x);
  ivec2 samples = (ivec2(1) << min(tile.level, ivec2(MAX_LOG))) + 1;
#ifdef ALONG_U
  ivec2 place = job.yz;
  samples.y = tile.degree.y + 1;
#else
  ivec2 place = tile.place;
#endif
  tilePlaceLog = ivec4(place, tile.level);
  tileFirstRows = ivec4(tile.first, job.yz);
  tileBlockPoint = ivec4(tile.block, tile.point, tile.stride);
  vec2 corner = vec2(place) + vec2(samples) * vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(2.0 * corner / targetSize - 1.0, 0.0, 1.0);
}
