#include "tools/viewing/light_mixer.hpp"

#include <fmt/format.h>
#include <half.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/machine_memory.hpp"
#include "base/text_file.hpp"
#include "image/exr_input.hpp"
#include "image/file_format.hpp"
#include "image/light_names.hpp"
#include "image/srgb.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

/// Groups that are read at a time. Reading decodes all of a file's channels, so one after the other would
/// take time by the square of their number.
constexpr std::size_t kReadBytes = std::size_t(512) << 20;

/// The group whose red channel this is; empty for another channel, such as that of a group's bounds.
std::string groupOfRed(const std::string& channel) {
  if (!channel.starts_with(kLightGroups) || !channel.ends_with(".R")) return "";
  const std::string name = channel.substr(kLightGroups.size());
  const std::size_t dot = name.find('.');
  return dot != std::string::npos && dot + 2 == name.size() ? name.substr(0, dot) : "";
}

/// The part of the file that has the groups' layers; -1 where none has.
int findPart(const ExrInput& input) {
  for (std::size_t part = 0; part < input.parts().size(); ++part) {
    const std::vector<std::string>& channels = input.parts()[part].channels;
    if (std::any_of(channels.begin(), channels.end(),
                    [](const std::string& name) { return !groupOfRed(name).empty(); }))
      return int(part);
  }
  return -1;
}

/// The same, but throws InputError where none has.
int partOf(const ExrInput& input, const std::string& path) {
  if (const int part = findPart(input); part >= 0) return part;
  throw InputError(
      fmt::format("{}: no layers {}NAME, which render --light-groups writes", path, kLightGroups));
}

/// Where a channel is; -1 where there is none of that name.
int placeOf(const PicturePart& part, const std::string& name) {
  const auto found = std::find(part.channels.begin(), part.channels.end(), name);
  return found == part.channels.end() ? -1 : int(found - part.channels.begin());
}

/// Reads the groups' planes, and calls take(group, planes of r, g and b) for one after the other.
void forEachGroup(ExrInput& input, const std::string& path, const std::vector<GroupFactor>& groups,
                  const std::function<void(std::size_t, const float*)>& take) {
  const int part = partOf(input, path);
  const PicturePart& header = input.parts()[std::size_t(part)];
  const std::size_t pixels = std::size_t(header.size.x) * std::size_t(header.size.y);
  const std::size_t at_once = std::max<std::size_t>(kReadBytes / (3 * pixels * sizeof(float)), 1);
  for (std::size_t first = 0; first < groups.size(); first += at_once) {
    const std::size_t end = std::min(first + at_once, groups.size());
    std::vector<int> channels;
    for (std::size_t group = first; group < end; ++group) {
      for (const char* component : {".R", ".G", ".B"}) {
        const std::string name = std::string(kLightGroups) + groups[group].group + component;
        channels.push_back(placeOf(header, name));
        if (channels.back() < 0)
          throw InputError(fmt::format("{}: channel {}: missing", path, forMessage(name)));
      }
    }
    const ChannelPlanes planes = input.read(part, channels);
    for (std::size_t group = first; group < end; ++group)
      take(group, planes.data() + 3 * pixels * (group - first));
  }
}

float finiteColor(double color) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return float(std::max(color < kLargest ? color : kLargest, -kLargest));
}

}  // namespace

std::optional<glm::vec3> linearColor(const std::string& color) {
  if (color.size() != 7 || color[0] != '#' ||
      color.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
    return std::nullopt;
  glm::vec3 linear;
  for (int c = 0; c < 3; ++c)
    linear[c] = float(decodeSrgb(std::stoi(color.substr(1 + 2 * c, 2), nullptr, 16) / 255.0));
  return linear;
}

std::vector<GroupFactor> lightGroupsOf(const std::string& path) {
  const ExrInput input(path);
  std::vector<GroupFactor> groups;
  for (const std::string& name : input.parts()[std::size_t(partOf(input, path))].channels)
    if (const std::string group = groupOfRed(name); !group.empty()) groups.push_back({group});
  return groups;
}

Image readLightGroups(const std::string& path) {
  ExrInput input(path);
  const int part = findPart(input);
  if (part < 0) return {};
  const PicturePart& header = input.parts()[std::size_t(part)];
  Image image{header.size.x, header.size.y, {}, {}};
  std::vector<int> places;
  for (std::size_t c = 0; c < header.channels.size(); ++c) {
    if (!header.channels[c].starts_with(kLightGroups)) continue;
    image.channels.push_back(header.channels[c]);
    places.push_back(int(c));
  }
  const std::size_t pixels = std::size_t(header.size.x) * std::size_t(header.size.y),
                    channels = places.size();
  const ChannelPlanes planes = input.read(part, places);
  requireMemory(double(pixels) * double(channels) * sizeof(float), path);
  image.pixels.resize(pixels * channels);
  tbb::parallel_for(std::size_t(0), pixels, [&](std::size_t i) {
    for (std::size_t c = 0; c < channels; ++c) image.pixels[i * channels + c] = planes[c * pixels + i];
  });
  return image;
}

Image mixLights(const std::string& path, const std::vector<GroupFactor>& groups, WriteOptions& options) {
  ExrInput input(path);
  const int part = partOf(input, path);
  const PicturePart& header = input.parts()[std::size_t(part)];
  const std::size_t pixels = std::size_t(header.size.x) * std::size_t(header.size.y);
  std::vector<double> sums;
  forEachGroup(input, path, groups, [&](std::size_t group, const float* planes) {
    if (sums.empty()) {  // not before a file that claims much has shown that it holds it
      requireMemory(double(pixels) * (3 * sizeof(double) + 4 * sizeof(float)), path);
      sums.resize(3 * pixels);
    }
    const glm::dvec3 factor(groups[group].factor);
    tbb::parallel_for(std::size_t(0), pixels, [&](std::size_t i) {
      for (int c = 0; c < 3; ++c) sums[3 * i + c] += factor[c] * double(planes[i + std::size_t(c) * pixels]);
    });
  });
  sums.resize(3 * pixels);  // of no groups
  Image image{header.size.x, header.size.y, {"R", "G", "B"}, {}};
  ChannelPlanes alpha;
  if (const int place = placeOf(header, "A"); place >= 0) {
    alpha = input.read(part, {place});
    image.channels.push_back("A");
  }
  const std::size_t channels = image.channels.size();
  image.pixels.resize(channels * pixels);
  tbb::parallel_for(std::size_t(0), pixels, [&](std::size_t i) {
    for (std::size_t c = 0; c < 3; ++c) image.pixels[channels * i + c] = finiteColor(sums[3 * i + c]);
    if (!alpha.empty()) image.pixels[channels * i + 3] = alpha[i];
  });
  options.picture_size = header.picture_size;
  options.crop_origin = header.crop_origin;
  options.display = header.display;
  options.exr.matrices = header.attributes.matrices;
  return image;
}

Image mixLights(const Image& layers, const std::vector<GroupFactor>& groups) {
  std::vector<std::size_t> places;  // of each group's r, g and b
  for (const GroupFactor& group : groups)
    for (const char* component : {".R", ".G", ".B"}) {
      const std::string name = std::string(kLightGroups) + group.group + component;
      const auto found = std::find(layers.channels.begin(), layers.channels.end(), name);
      if (found == layers.channels.end()) throw InputError(forMessage(name) + ": missing");
      places.push_back(std::size_t(found - layers.channels.begin()));
    }
  Image image{layers.width, layers.height, {"R", "G", "B"}, {}};
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
  image.pixels.resize(3 * pixels);
  tbb::parallel_for(std::size_t(0), pixels, [&](std::size_t i) {
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (std::size_t group = 0; group < groups.size(); ++group)
        sum += double(groups[group].factor[int(c)]) *
               double(layers.pixels[i * layers.channels.size() + places[3 * group + c]]);
      image.pixels[3 * i + c] = finiteColor(sum);
    }
  });
  return image;
}

SmallGroups smallGroups(const std::string& path, const std::vector<GroupFactor>& groups,
                        std::size_t most_bytes) {
  ExrInput input(path);
  const glm::ivec2 size = input.parts()[std::size_t(partOf(input, path))].size;
  const std::size_t pixels = std::size_t(size.x) * std::size_t(size.y);
  int side = 1;  // of the squares
  const auto shrunk = [&] { return glm::ivec2((size.x + side - 1) / side, (size.y + side - 1) / side); };
  while (side < std::max(size.x, size.y) &&
         std::size_t(shrunk().x) * std::size_t(shrunk().y) * 3 * sizeof(half) * groups.size() > most_bytes)
    ++side;
  SmallGroups small{shrunk().x, shrunk().y, {}};
  const std::size_t group_values = 3 * std::size_t(small.width) * std::size_t(small.height);
  small.halves.resize(group_values * groups.size());
  forEachGroup(input, path, groups, [&](std::size_t group, const float* planes) {
    tbb::parallel_for(0, small.height, [&](int y) {
      std::uint16_t* out =
          small.halves.data() + group * group_values + 3 * std::size_t(y) * std::size_t(small.width);
      for (int x = 0; x < small.width; ++x) {
        const glm::ivec2 first(x * side, y * side), end = glm::min(first + side, size);
        for (int c = 0; c < 3; ++c) {
          double sum = 0;
          for (int row = first.y; row < end.y; ++row)
            for (int column = first.x; column < end.x; ++column)
              sum += double(planes[std::size_t(c) * pixels + std::size_t(row) * std::size_t(size.x) +
                                   std::size_t(column)]);
          const double mean = sum / ((end.x - first.x) * (end.y - first.y));
          *out++ = half(std::min(finiteColor(mean), kLargestHalf)).bits();
        }
      }
    });
  });
  return small;
}

}  // namespace luciole
