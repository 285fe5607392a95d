#include "shadow/maps/lookups.hpp"

namespace luciole {

std::vector<KernelArgument> lookupArguments(const Lookups& lookups) {
  return {{"plane_stride", uint(lookups.plane_stride)},
          {"position", lookups.position},
          {"normal", lookups.normal},
          {"lift", lookups.lift},
          {"lights", lookups.lights},
          {"light_count", uint(lookups.light_count)},
          {"list_starts", lookups.lists.starts},
          {"list", lookups.lists.list},
          {"shadow_maps", lookups.shadow_maps},
          {"shadow_faces", lookups.shadow_faces}};
}

}  // namespace luciole
