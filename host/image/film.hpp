#pragma once

#include <memory>
#include <string>

namespace luciole {

class RowFile;

/// Whether a file of this name is a film, or of the format that is named (see outputFormat): mp4 (H.264),
/// webm (VP9), or webp, which may be a single picture as well.
bool isFilm(const std::string& path, const std::string& format = "");

/// Throws what making a film would meet, before any work is done: InputError for a format that is no film's,
/// a folder that isn't there or can't be written to, or a stream in the file's place; MachineError where
/// there is no program ffmpeg.
void checkFilm(const std::string& path, const std::string& format = "");

/// A film, encoded by the program ffmpeg while its frames come. The file appears whole or not at all (see
/// OutputFile): ffmpeg writes to it while it has no name, and is ended if anything fails.
class Film {
 public:
  /// Starts ffmpeg. Throws as checkFilm does, and InputError where the format can't have the size: H.264 with
  /// a colour for each 2 x 2 pixels takes even ones.
  Film(const std::string& path, const std::string& format, int width, int height, double frames_per_second);
  /// Without close() no file appears.
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// The next frame: takes rows of 8-bit R G B in sRGB, all of them before the next frame. Its close() does
  /// nothing. Its write() throws MachineError where ffmpeg has failed.
  std::unique_ptr<RowFile> addFrame();

  /// After the last frame: waits for ffmpeg and puts the file in place. Throws MachineError where ffmpeg has
  /// failed, with the first line that it said.
  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace luciole
