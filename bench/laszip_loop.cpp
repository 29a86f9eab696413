// The baseline of LAZ import: one thread reads every point of a file with LASzip and adds up the coordinates.
//   laszip_loop FILE.laz

#include <laszip/laszip_api.h>

#include <cstdio>

int main(int argc, char** argv) {
  laszip_POINTER reader = nullptr;
  laszip_BOOL compressed = 0;
  laszip_header* header = nullptr;
  laszip_point* point = nullptr;
  if (argc != 2 || laszip_create(&reader) != 0 || laszip_open_reader(reader, argv[1], &compressed) != 0 ||
      laszip_get_header_pointer(reader, &header) != 0 || laszip_get_point_pointer(reader, &point) != 0) {
    std::fprintf(stderr, "usage: laszip_loop FILE.laz\n");
    return 2;
  }
  const laszip_U64 count = header->number_of_point_records != 0 ? header->number_of_point_records
                                                                : header->extended_number_of_point_records;
  double sum = 0.0;
  laszip_F64 coordinates[3];
  for (laszip_U64 i = 0; i < count; ++i) {
    if (laszip_read_point(reader) != 0 || laszip_get_coordinates(reader, coordinates) != 0) return 1;
    sum += coordinates[0] + coordinates[1] + coordinates[2] + point->gps_time;
  }
  std::printf("%llu points, checksum %.3f\n", static_cast<unsigned long long>(count), sum);
  laszip_close_reader(reader);
  laszip_destroy(reader);
  return 0;
}
