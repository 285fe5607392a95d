#include "lighting/compile_helper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "kernels/probe.hpp"
#include "luciole/error.hpp"

namespace luciole::test {
namespace {

using testing::ElementsAre;

CompileTask someTask() {
  CompileTask task;
  for (const std::initializer_list<Feature> some :
       {std::initializer_list<Feature>{Feature::kPointLights, Feature::kPhong, Feature::kExact},
        {Feature::kAmbient, Feature::kMaterialModels}}) {
    FeatureSet& features = task.programs.emplace_back();
    for (const Feature feature : some) features.set(feature);
  }
  task.settings.log2_degree = 5;
  task.settings.exp2_degree = 4;
  task.settings.pcf_width = 3;
  task.settings.tile_size = 16;
  task.settings.soft_samples = 99;
  task.settings.user_text = "INLINE floatL f(floatL x) { return x; }\n";
  task.choice.others = false;
  task.quickly = true;
  return task;
}

TEST(CompileTask, IsReadAsItWasWritten) {
  OpenedDevice device;
  for (const char* selector : {"", "1,lanes=4"}) {
    device.selector = selector;
    const DeviceTask read = readTask(argumentsOf(device, someTask()));
    EXPECT_EQ(read.selector, selector);
    EXPECT_EQ(read.task.programs, someTask().programs);
    EXPECT_EQ(argumentsOf(device, read.task), argumentsOf(device, someTask()));
    EXPECT_EQ(read.task.settings.soft_samples, 99);
    EXPECT_EQ(read.task.settings.user_text, someTask().settings.user_text);
    EXPECT_TRUE(read.task.quickly && read.task.choice.beams && !read.task.choice.others);
  }
}

TEST(CompileTask, OfOthersIsRefused) {
  const std::vector<std::string> good = argumentsOf(OpenedDevice(), someTask());
  for (std::size_t i = 0; i < good.size(); ++i)
    for (const char* wrong : {"", "x", "-1x", "99999999999999999999"}) {
      std::vector<std::string> words = good;
      words[i] = wrong;
      EXPECT_THROW(readTask(words), InputError) << i << " " << wrong;
    }
  EXPECT_THROW(readTask({}), InputError);
  EXPECT_THROW(readTask(std::span(good).first(10)), InputError);
}

TEST(HelperProcess, ThatFailsIsToldAndOneThatCantBeStartedIsNone) {
  OpenedDevice device;
  HelperProcess helper;
  EXPECT_TRUE(helper.await());
  for (const auto& [program, succeeds] :
       {std::pair{"", true}, {"/nonexistent", true}, {"/bin/true", true}, {"/bin/false", false}}) {
    device.helper = program;
    helper.start(device, someTask());
    EXPECT_EQ(helper.await(), succeeds) << program;
    EXPECT_TRUE(helper.await());
  }
}

}  // namespace
}  // namespace luciole::test
