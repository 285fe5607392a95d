#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "tools/bench/child_process.hpp"
#include "tools/scale/scale.hpp"

namespace luciole {

/// Adds the methods of --against to an experiment, each NAME=PICTURES, NAME=PICTURES,ms=TIME or NAME=-
/// (`luciole scale --help` says what they mean). Looks at all pictures that are there, and lists those that
/// aren't, of a method that has some, in experiment.missing. Throws InputError.
void addAgainst(const std::vector<std::string>& against, ScaleExperiment& experiment);

/// Whether some method's pictures are asked for.
bool asksForPictures(const ScaleExperiment& experiment);

/// Asks whoever reads standard output and writes standard input for pictures, a line of JSON each way, as
/// host/tools/scale/README.md has it. Scenes are written for them into a folder that lives as long as this.
class PictureQuestions {
 public:
  /// scene_path: of the surfaces; empty: those of the file `gbuffer`. frame: of the scene.
  PictureQuestions(const std::string& scene_path, const std::string& gbuffer, int frame);

  /// Throws NoPicture if the answer says so, and InputError if there is none or it says nothing.
  AskedPicture ask(const PictureRequest& request);

 private:
  std::string scene_path_, gbuffer_;
  int frame_;
  ScratchFolder folder_;
  std::set<std::uint64_t> written_;  ///< numbers of lights whose scene is
  std::size_t answers_ = 0;
};

}  // namespace luciole
