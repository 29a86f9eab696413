#pragma once
/// The list of the commands, for `raycloud`, which must know them without starting them. A test compares it
/// with the tables of the commands themselves (tests/unit/cli/commands_agree.sh).

#include <array>
#include <string_view>

namespace ray::cli {

struct ListedCommand {
  std::string_view name;
  std::string_view summary;  ///< Command::summary
};

inline constexpr std::array kCommands{
    ListedCommand{"rayimport", "make a ray cloud from points and what is known of the sensor"},
    ListedCommand{"rayexport", "write the points and the trajectory of a ray cloud"},
    ListedCommand{"raycreate", "make a ray cloud of a world that is known exactly"},
    ListedCommand{"rayinfo", "what is in a ray cloud"},
    ListedCommand{"raytranslate", "move a ray cloud, in place"},
    ListedCommand{"rayrotate", "rotate a ray cloud about the origin, in place"},
    ListedCommand{"rayalign", "align a ray cloud to its own axes, or onto another"},
    ListedCommand{"raydecimate", "thin a ray cloud"},
    ListedCommand{"rayrestore", "apply the edits of a thinned ray cloud to the full one"},
    ListedCommand{"raydenoise", "take noise out of a ray cloud"},
    ListedCommand{"raytransients", "take out what came, went or moved while the cloud was scanned"},
    ListedCommand{"raycolour", "colour a ray cloud"},
    ListedCommand{"raypipe", "run several commands as one, without files between them"},
    ListedCommand{"raysmooth", "move end points onto the surface they are samples of"},
    ListedCommand{"raysplit", "split a ray cloud in two, or into cells"},
    ListedCommand{"raycombine", "put ray clouds together"},
    ListedCommand{"raydiff", "what came and what went between two ray clouds"},
    ListedCommand{"rayrender", "picture a ray cloud"},
    ListedCommand{"raywrap", "wrap a ray cloud in a mesh"},
    ListedCommand{"rayextract", "find the ground in a ray cloud"},
};

}  // namespace ray::cli
