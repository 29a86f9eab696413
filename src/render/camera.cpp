#include <raycloud/render/camera.h>

namespace ray {

Camera camera_of(View view) {
  constexpr SignedAxis kX{0, 1.0};
  constexpr SignedAxis kY{1, 1.0};
  constexpr SignedAxis kZ{2, 1.0};
  constexpr SignedAxis kMinusX{0, -1.0};
  constexpr SignedAxis kMinusY{1, -1.0};
  switch (view) {
    case View::front:
      return {kX, kZ, kMinusY};
    case View::back:
      return {kMinusX, kZ, kY};
    case View::left:
      return {kMinusY, kZ, kMinusX};
    case View::right:
      return {kY, kZ, kX};
    case View::top:
      break;
  }
  return {kX, kY, kZ};
}

}  // namespace ray
