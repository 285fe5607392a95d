#include "tools/scale/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "luciole/error.hpp"
#include "tools/cli/run_program.hpp"
#include "tools/scale/browser.hpp"
#include "tools/scale/made_up_page.hpp"

// The page of an experiment: as text, and as a browser shows it.
namespace luciole::test {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

std::string pageOf(const Json& data) { return experimentPage(data.dump()); }

std::size_t countOf(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++count;
  return count;
}

/// A page's text without the elements of one kind.
std::string withoutElement(std::string page, const std::string& name) {
  const std::string end = "</" + name + ">";
  for (std::size_t open; (open = page.find("<" + name)) != std::string::npos;)
    page.erase(open, page.find(end, open) + end.size() - open);
  return page;
}

/// Chart.js's chart of a figure.
std::string chartOf(const std::string& figure) {
  return "Chart.getChart(document.querySelector('#" + figure + " canvas'))";
}

/// The values of a chart's lines: {name: [[x, y], …]}.
Json linesOf(Browser& browser, const std::string& figure) {
  return browser.evaluate(
      "Object.fromEntries(" + chartOf(figure) +
      ".data.datasets.map(line => [line.label, line.data.map(value => [value.x, value.y])]))");
}

/// Chooses an option of a select as a person does.
void choose(Browser& browser, const std::string& id, const std::string& text) {
  browser.evaluate(
      "(() => { const select = document.getElementById('" + id +
      "'); select.value = [...select.options].find(option => option.text === " + Json(text).dump() +
      ").value; select.dispatchEvent(new Event('change', {bubbles: true})); })()");
  browser.settle();
}

/// Whether each plot shows each of its lines: whether their colours are on its canvas.
constexpr const char* kPlotsDrawn = R"([...document.querySelectorAll('canvas')].map(canvas => {
  const pixels = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
  const found = new Set();
  for (let i = 0; i < pixels.length; i += 4)
    found.add('#' + [...pixels.subarray(i, i + 3)].map(channel => channel.toString(16).padStart(2, '0')).join(''));
  return Chart.getChart(canvas).data.datasets.every(line => found.has(line.borderColor));
}))";

// ------------------------------------------------------------------------------------------------ as text

TEST(Page, IsOneFileThatNamesNothingToFetch) {
  const std::string page = pageOf(madeUpVariants());
  EXPECT_THAT(page, StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(page, HasSubstr("Released under the MIT License"));
  EXPECT_THAT(page, HasSubstr("luciole scale 'a scene.obj'"));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  const std::string markup = withoutElement(withoutElement(page, "script"), "style");
  EXPECT_FALSE(std::regex_search(markup, std::regex("(src|href)=\"(?!data:|#)"))) << markup;
  EXPECT_EQ(countOf(page, "{{"), 0U);
}

TEST(Page, EndsItsScriptsOnlyWhereTheyEnd) {
  Json data = madeUpVariants();
  data["title"] = "</script><!-- <script>";
  const std::string page = pageOf(data);
  EXPECT_EQ(countOf(page, "</script>"), 3U);
  EXPECT_EQ(countOf(page, "<!--"), 1U);  // the comment of page.html
}

TEST(Page, SaysWhatToInstallWhereChartJsIsMissing) {
  EXPECT_NO_THROW(requireChartLibrary());
  try {
    requireChartLibrary("/nowhere/chart.min.js");
    FAIL() << "no error";
  } catch (const MachineError& error) {
    EXPECT_THAT(error.what(), StartsWith("/nowhere/chart.min.js: "));
    EXPECT_THAT(error.what(), HasSubstr("install libjs-chart.js"));
  }
}

// -------------------------------------------------------------------------------------------- in a browser

TEST(PageInBrowser, DrawsEveryPlotFromItsDataOffTheNetworkWithoutComplaint) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.open(pageOf(madeUpVariants()));
  EXPECT_THAT(linesOf(browser, "compared_plot"),
              Json({{"culling none", {{1, 2.01}, {100, 3}, {10000, 102}}},
                    {"culling tiles", {{1, 2.02}, {100, 4}, {10000, 202}}},
                    {"culling a \"tree\", in full", {{1, 2.03}, {100, 5}, {10000, 302}}}}));
  EXPECT_THAT(linesOf(browser, "stage_plot"), Json({{"total", {{1, 2.01}, {100, 3}, {10000, 102}}},
                                                    {"rasterize", {{1, 2}, {100, 2}, {10000, 2}}},
                                                    {"shade", {{1, 0.01}, {100, 1}, {10000, 100}}}}));
  EXPECT_THAT(linesOf(browser, "pairs_plot"),
              Json({{"evaluated", {{1, 2000}, {100, 200000}, {10000, 20000000}}},
                    {"in range", {{1, 1000}, {100, 100000}, {10000, 10000000}}}}));
  EXPECT_THAT(linesOf(browser, "memory_plot"),
              Json({{"device", {{1, 40000064}, {100, 40006400}, {10000, 40640000}}},
                    {"peak of the program", {{1, 180000200}, {100, 180020000}, {10000, 182000000}}}}));
  EXPECT_EQ(browser.evaluate(chartOf("stage_plot") +
                             ".data.datasets[0].data.map(value => [value.low, value.high])"),
            Json({{1.91, 2.51}, {2.9, 3.5}, {101.9, 102.5}}));
  EXPECT_EQ(browser.evaluate(kPlotsDrawn), Json({true, true, true, true, true}));
  EXPECT_EQ(
      browser.evaluate(
          "[...document.querySelectorAll('canvas')].every(canvas => canvas.getAttribute('role') === 'img' && "
          "canvas.getAttribute('aria-label').startsWith('Plot of '))"),
      true);
  EXPECT_THAT(browser.complaints(), IsEmpty());
  for (const std::string& address : browser.requests())
    EXPECT_TRUE(address.starts_with("file:") || address.starts_with("data:") || address == "about:blank")
        << address;
}

TEST(PageInBrowser, SummarizesInASentenceAndSaysWhatIsMissing) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  Json data = madeUpVariants();
  data["title"] = "</script><b>bold</b> & \"quoted\"";
  data["incomplete"] = 3;
  browser.open(pageOf(data));
  EXPECT_EQ(browser.evaluate("document.querySelector('h1').textContent"), data["title"]);
  EXPECT_EQ(browser.evaluate("document.getElementById('summary').textContent"),
            "With culling none, the fastest of 3 variants, 10,000 lights take 102 ms, 50.7 times as long as "
            "1 light, "
            "without error; culling a \"tree\", in full, the slowest, takes 302 ms.");
  EXPECT_EQ(browser.evaluate("document.getElementById('incomplete').innerText"),
            "3 points have not been measured in full.");
  EXPECT_EQ(browser.evaluate("document.querySelector('#machine dl').innerText"),
            "Memory\n8 GiB\nProcessor\nA processor\nThreads\n2");
  EXPECT_EQ(browser.evaluate("document.querySelector('#growth_table tbody tr').innerText.split('\\t')"),
            Json({"culling none", "1.00 (0.95 to 1.05)"}));
}

TEST(PageInBrowser, SaysWhyThereIsNoGrowth) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  Json data = madeUpVariants();
  data["growth"][0].update({{"c", nullptr}, {"reason", "too few numbers of lights: 3 of 5"}});
  browser.open(pageOf(data));
  EXPECT_EQ(browser.evaluate("document.querySelector('#growth_table tbody tr').innerText.split('\\t')"),
            Json({"culling none", "too few numbers of lights: 3 of 5"}));
  browser.evaluate("document.querySelector('#growth_table details').open = true");
  browser.settle();
  EXPECT_EQ(
      browser.evaluate("document.querySelectorAll('#growth_table tbody')[1].rows[1].innerText.split('\\t')"),
      Json({"none", "rasterize", "–", "–", "–", "–", "–", "no growth beyond noise"}));
}

TEST(PageInBrowser, NamesOfTheFrontAreNotStruckThroughByItsLine) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.open(pageOf(madeUpFront()));
  // What is written on the plot when it is drawn again, and the front between its points.
  const Json struck = browser.evaluate(R"((() => {
    const chart = )" + chartOf("error_plot") +
                                       R"(, context = chart.ctx, texts = [];
    const fillText = context.fillText;
    context.fillText = (text, x, y) => {
      texts.push({text, left: x, right: x + context.measureText(text).width, top: y - 5, bottom: y + 5});
      fillText.call(context, text, x, y);
    };
    chart.draw();
    const names = texts.filter(({text}) => text.startsWith('way '));
    const struck = new Set();
    const front = chart.getDatasetMeta(chart.data.datasets.findIndex(({label}) => label.startsWith('front'))).data;
    for (let i = 1; i < front.length; ++i)
      for (let share = 0; share <= 1; share += 0.001) {
        const x = front[i - 1].x + share * (front[i].x - front[i - 1].x), y = front[i - 1].y + share * (front[i].y - front[i - 1].y);
        for (const name of names) if (x > name.left && x < name.right && y > name.top && y < name.bottom) struck.add(name.text);
      }
    return {names: names.length, front: front.length, struck: [...struck]};
  })())");
  EXPECT_EQ(struck["front"], 6) << struck;
  EXPECT_GE(struck["names"], 5) << struck;
  EXPECT_EQ(struck["struck"], Json::array());
}

TEST(PageInBrowser, ShowsZeroErrorBelowAllOthersUnderItsOwnName) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.open(pageOf(madeUpVariants()));
  const Json lines = linesOf(browser, "error_plot");
  const double floor = lines["culling none"][0][1];
  EXPECT_GT(floor, 0);
  EXPECT_LT(floor, 1e-6);
  EXPECT_EQ(lines["culling tiles"], Json({{202, 1e-6}}));
  // The front goes from the fastest to the most right.
  EXPECT_EQ(lines["front at 10,000 lights"], Json({{102, floor}, {202, 1e-6}, {302, 2e-6}}));
  EXPECT_EQ(browser.evaluate(chartOf("error_plot") + ".scales.y.ticks[0].label"), "0");
  EXPECT_EQ(browser.evaluate(chartOf("error_plot") + ".scales.y.ticks[0].value"), floor);

  // Where nothing is wrong, the axis has nothing else.
  Json right = madeUpVariants();
  for (Json& point : right["points"]) point["error"]["mean_abs"] = 0;
  browser.open(pageOf(right));
  EXPECT_EQ(browser.evaluate(chartOf("error_plot") + ".scales.y.ticks.map(tick => tick.label)"), Json({"0"}));
}

/// Three methods of shadows, the first of them none.
Json madeUpShadows() {
  Json data = madeUpVariants();
  const std::vector<std::string> methods{"off", "hard", "pcf"};
  data["axes"] = {{{"name", "shadows"}, {"values", methods}}};
  for (std::size_t i = 0; i < data["points"].size(); ++i) {
    Json& point = data["points"][i];
    point["values"] = {{"shadows", methods[i / 3]}};
    point["truth"] = i / 3 == 0 ? "no shadows" : "shadows by rays";
  }
  data["growth"] = Json::array();
  return data;
}

TEST(PageInBrowser, PointsOfDifferentTruthsAreKeptApartAndItSaysSo) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.open(pageOf(madeUpShadows()));
  EXPECT_EQ(
      browser.evaluate("document.getElementById('truths').innerText"),
      "The variants are meant to make 2 different pictures, and each is held against a reference of its own: "
      "no shadows; shadows by rays. Errors compare, and fronts are drawn, only between points held against "
      "the same one.");
  EXPECT_EQ(
      browser.evaluate("document.getElementById('summary').textContent"),
      "No shadows: 10,000 lights take 102 ms, 50.7 times as long as 1 light, without error. "
      "Shadows by rays: with shadows hard, the fastest of 2 variants, 10,000 lights take 202 ms, 100 times "
      "as long as 1 light, with a mean error of 10⁻⁶; shadows pcf, the slowest, takes 302 ms.");
  const auto shown = [&] {
    std::vector<std::string> names;
    const Json lines = linesOf(browser, "error_plot");
    for (const auto& [name, values] : lines.items()) names.push_back(name);
    return names;
  };
  EXPECT_THAT(shown(), ElementsAre("front at 10,000 lights, shadows by rays", "shadows hard", "shadows pcf"));
  choose(browser, "error_truth", "no shadows");
  EXPECT_THAT(shown(), ElementsAre("shadows off"));
  choose(browser, "error_truth", "each its own, all in one plot");
  EXPECT_THAT(shown(), ElementsAre("front at 10,000 lights, shadows by rays", "shadows hard", "shadows off",
                                   "shadows pcf"));
  EXPECT_EQ(browser.evaluate("[...document.querySelectorAll('#points_table th[scope=col]')].some(cell => "
                             "cell.innerText === 'Held against')"),
            true);
  EXPECT_THAT(browser.complaints(), IsEmpty());

  browser.open(pageOf(madeUpVariants()));
  EXPECT_EQ(browser.evaluate("document.getElementById('truths').checkVisibility()"), false);
  EXPECT_EQ(browser.evaluate("document.getElementById('error_truth').checkVisibility()"), false);
}

TEST(PageInBrowser, SaysUnderItsTableWhyACellIsADash) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  Json data = madeUpVariants();
  data["points"][0]["reach"] = nullptr;
  data["points"][1]["reach"] = 3;
  data["points"][0]["reasons"] = {{"reach", "a light without a range reaches everywhere"}};
  data["points"][2]["pairs_in_range"] = 0;
  browser.open(pageOf(data));
  EXPECT_EQ(browser.evaluate("document.querySelector('#points_table p').innerText"),
            "–: a light without a range reaches everywhere; no light is in range of a pixel.");
  EXPECT_EQ(browser.evaluate("/NaN|Infinity|undefined/.test(document.body.innerText)"), false);
}

TEST(PageInBrowser, ChoicesChangeWhatIsShown) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.open(pageOf(madeUpVariants()));
  choose(browser, "variant", "culling tiles");
  EXPECT_EQ(linesOf(browser, "stage_plot")["total"], Json({{1, 2.02}, {100, 4}, {10000, 202}}));
  EXPECT_EQ(linesOf(browser, "pairs_plot")["list entries"], Json({{1, 3}, {100, 300}, {10000, 30000}}));
  choose(browser, "quantity", "time of shade");
  EXPECT_EQ(linesOf(browser, "compared_plot")["culling tiles"], Json({{1, 0.02}, {100, 2}, {10000, 200}}));
  choose(browser, "error_lights", "all");
  EXPECT_EQ(linesOf(browser, "error_plot")["culling tiles"], Json({{2.02, 1e-6}, {4, 1e-6}, {202, 1e-6}}));
  choose(browser, "error_kind", "largest absolute error");
  EXPECT_EQ(linesOf(browser, "error_plot")["culling tiles"][0], Json({2.02, 50 * 1e-6}));
  choose(browser, "error_kind", "relative mean square error (relMSE)");
  EXPECT_EQ(linesOf(browser, "error_plot")["culling tiles"][0], Json({2.02, 3 * 1e-6}));
  EXPECT_EQ(linesOf(browser, "error_plot").size(), 3u) << "no front by this error is told";
  choose(browser, "error_kind", "bias: |mean signed error|");
  EXPECT_EQ(linesOf(browser, "error_plot")["culling tiles"][0], Json({2.02, 1e-6 / 2}));
  choose(browser, "quantity", "smape");
  EXPECT_EQ(linesOf(browser, "compared_plot")["culling tiles"][0], Json({1, 4 * 1e-6}));
  // A name in the legend is a switch.
  browser.evaluate("document.querySelector('#compared_plot .legend button').click()");
  EXPECT_EQ(browser.evaluate(chartOf("compared_plot") + ".isDatasetVisible(0)"), false);
  EXPECT_EQ(browser.evaluate("document.querySelector('#compared_plot .legend button').ariaPressed"), "false");

  const auto pictures = [&] {
    return browser.evaluate("['a', 'b'].map(side => document.getElementById('picture_' + side).src)");
  };
  EXPECT_EQ(pictures(), Json({kTinyPictures[0], kTinyPictures[1]}));
  choose(browser, "point_b", "100 lights, culling tiles");
  choose(browser, "kind_b", "Tile heat map");
  EXPECT_EQ(pictures(), Json({kTinyPictures[0], kTinyPictures[2]}));
  EXPECT_EQ(browser.evaluate("document.getElementById('caption_b').innerText"),
            "B: Tile heat map · 100 lights · culling tiles · 4 ms · mean error 10⁻⁶");
  // A point without this kind shows another of its own.
  choose(browser, "point_b", "100 lights, culling none");
  EXPECT_EQ(pictures()[1], kTinyPictures[0]);
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

TEST(PageInBrowser, OtherMethodsStandBesideItsOwnVariants) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.open(pageOf(madeUpMethods()));
  const auto names = [&](const std::string& figure) {
    std::vector<std::string> found;
    const Json lines = linesOf(browser, figure);
    for (const auto& [name, values] : lines.items()) found.push_back(name);
    return found;
  };
  EXPECT_THAT(names("compared_plot"), ElementsAre("culling none", "culling tiles", "theirs"));
  EXPECT_THAT(names("error_plot"), ElementsAre("culling none", "culling tiles", "theirs"));
  choose(browser, "quantity", "relmse");
  EXPECT_EQ(linesOf(browser, "compared_plot")["untimed"].size(), 2u);
  // Of other methods there are no stages to look at.
  EXPECT_EQ(browser.evaluate("[...document.getElementById('variant').options].map(option => option.text)"),
            Json({"culling none", "culling tiles"}));
  EXPECT_EQ(browser.evaluate("document.getElementById('summary').textContent"),
            "With culling none, the fastest of 3 variants, 10,000 lights take 202 ms, 50.5 times "
            "as long as 100 lights, with a mean error of 10⁻⁶; theirs, the slowest, takes 402 ms.");
  // A multiple of the first variant, with its interval, beside the point.
  EXPECT_EQ(browser.evaluate(chartOf("error_plot") +
                             ".data.datasets.find(line => line.label === 'theirs').data[0].note"),
            "10,000 lights, 402 ms, 2.5 (2.25 to 2.75) times culling none");
  EXPECT_EQ(browser.evaluate("[...document.querySelectorAll('#points_table tbody tr')].map(row => "
                             "row.innerText.split('\\t').slice(0, 3).join(' '))[3]"),
            "100 - untimed");
  EXPECT_THAT(browser.evaluate("document.querySelector('#points_table p').innerText").get<std::string>(),
              HasSubstr("another method whose times are not known"));
  EXPECT_EQ(browser.evaluate("/NaN|Infinity|undefined|null/.test(document.body.innerText)"), false);
  EXPECT_THAT(browser.complaints(), IsEmpty());
  choose(browser, "point_a", "10,000 lights, untimed");
  EXPECT_EQ(browser.evaluate("document.getElementById('caption_a').innerText"),
            "A: Picture · 10,000 lights · untimed · mean error 4 · 10⁻⁶");
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

TEST(PageInBrowser, SlidersGoThroughTheLightErrorsOfOneNumberOfLights) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.open(pageOf(madeUpPageOfLightErrors()));
  const auto shown = [&](const std::string& side) {
    return browser.evaluate(
        "[document.getElementById('picture_" + side + "').src, document.getElementById('error_" + side +
        "').value, document.getElementById('error_" + side +
        "_value').textContent, document.getElementById('point_" + side + "').selectedOptions[0].text]");
  };
  // The fastest of the most lights is exact: the end of the row. It has no bounds to show.
  EXPECT_EQ(shown("a"), Json({kTinyPictures[0], "2", "0", "10,000 lights, light-error 0"}));
  choose(browser, "point_b", "10,000 lights, light-error 1/256");
  choose(browser, "kind_b", "Bound map");
  EXPECT_EQ(shown("b"), Json({kTinyPictures[1], "1", "1/256", "10,000 lights, light-error 1/256"}));
  browser.evaluate("document.getElementById('error_b').focus()");
  browser.press("ArrowLeft", 37);
  browser.settle();
  EXPECT_EQ(shown("b"), Json({kTinyPictures[2], "0", "1/16", "10,000 lights, light-error 1/16"}));
  EXPECT_EQ(browser.evaluate("document.getElementById('error_b').getAttribute('aria-valuetext')"), "1/16");
  EXPECT_EQ(shown("a")[3], "10,000 lights, light-error 0") << "each side has its own";
  // At the exact end there is another kind to show.
  browser.press("End", 35);
  browser.settle();
  EXPECT_EQ(shown("b"), Json({kTinyPictures[0], "2", "0", "10,000 lights, light-error 0"}));
  choose(browser, "point_b", "100 lights, light-error 1/16");
  EXPECT_EQ(shown("b")[1], "0");
  EXPECT_THAT(browser.complaints(), IsEmpty());

  browser.open(pageOf(madeUpVariants()));
  EXPECT_EQ(browser.evaluate("document.getElementById('error_a').checkVisibility()"), false);
}

TEST(PageInBrowser, DrawsBoundsBesideTrueErrorsAgainstTime) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  Json data = madeUpPageOfLightErrors();
  browser.open(pageOf(data));
  EXPECT_EQ(linesOf(browser, "bound_plot"), Json({{"bound", {{302, 1.0 / 32}, {502, 1.0 / 512}}},
                                                  {"true error", {{302, 1.0 / 320}, {502, 1.0 / 5120}}}}));
  choose(browser, "bound_kind", "the mean");
  EXPECT_EQ(linesOf(browser, "bound_plot")["true error"], Json({{302, 1.0 / 1280}, {502, 1.0 / 20480}}));
  EXPECT_EQ(
      browser.evaluate("[...document.getElementById('bound_lights').options].map(option => option.text)"),
      Json({"10,000"}));
  EXPECT_EQ(browser.evaluate("document.getElementById('violations').checkVisibility()"), false);
  EXPECT_THAT(browser.complaints(), IsEmpty());

  data["violations"] = {"lights=1 is wrong", "lights=2 is wrong"};
  browser.open(pageOf(data));
  EXPECT_EQ(browser.evaluate("document.getElementById('violations').innerText"),
            "Bounds are broken, which is a fault of the program: lights=1 is wrong; lights=2 is wrong.");
  browser.open(pageOf(madeUpVariants()));
  EXPECT_EQ(browser.evaluate("document.getElementById('bounds').checkVisibility()"), false);
}

TEST(PageInBrowser, SliderDividesThePicturesByKeyboardPointerAndTouch) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.open(pageOf(madeUpVariants()));
  // The share of the width at which each picture is cut, from its left and right, and where the divider
  // stands.
  const auto cuts = [&] {
    browser.settle();
    return browser.evaluate(R"((() => {
      const a = document.getElementById('picture_a'), b = document.getElementById('picture_b'), box = a.getBoundingClientRect();
      const divider = document.getElementById('divider').getBoundingClientRect();
      return [getComputedStyle(a).clipPath, getComputedStyle(b).clipPath, Math.round(100 * ((divider.left + divider.right) / 2 - box.left) / box.width)];
    })())");
  };
  EXPECT_EQ(cuts(), Json({"inset(0px 50% 0px 0px)", "inset(0px 0px 0px 50%)", 50}));
  browser.evaluate("document.getElementById('split').focus()");
  for (int i = 0; i < 3; ++i) browser.press("ArrowRight", 39);
  EXPECT_EQ(cuts(), Json({"inset(0px 47% 0px 0px)", "inset(0px 0px 0px 53%)", 53}));
  browser.press("Home", 36);
  EXPECT_EQ(cuts(), Json({"inset(0px 100% 0px 0px)", "inset(0px 0px 0px 0%)", 0}));

  browser.evaluate("document.getElementById('viewer').scrollIntoView({block: 'start', behavior: 'instant'})");
  browser.settle();
  const Json box = browser.evaluate(
      "(({left, top, width, height}) => [left, top, width, "
      "height])(document.getElementById('picture_a').getBoundingClientRect())");
  const double left = box[0], width = box[2], y = box[1].get<double>() + box[3].get<double>() / 2;
  browser.mouse("mousePressed", left + 0.25 * width, y);
  EXPECT_EQ(cuts()[2], 25);
  browser.mouse("mouseMoved", left + 0.8 * width, y);
  EXPECT_EQ(cuts(), Json({"inset(0px 20% 0px 0px)", "inset(0px 0px 0px 80%)", 80}));
  browser.mouse("mouseReleased", left + 0.8 * width, y);
  EXPECT_EQ(browser.evaluate("document.getElementById('split').value"), "80");

  browser.call("Emulation.setTouchEmulationEnabled", {{"enabled", true}});
  const auto touch = [&](const std::string& type, double share) {
    const Json finger{{"x", left + share * width}, {"y", y}};
    browser.call(
        "Input.dispatchTouchEvent",
        {{"type", type}, {"touchPoints", type == "touchEnd" ? Json::array() : Json::array({finger})}});
  };
  touch("touchStart", 0.3);
  for (const double share : {0.4, 0.5, 0.6}) touch("touchMove", share);
  touch("touchEnd", 0.6);
  EXPECT_EQ(cuts()[2], 60);

  browser.evaluate("document.getElementById('beside').click()");
  EXPECT_EQ(cuts()[0], "none");
  EXPECT_EQ(browser.evaluate("document.getElementById('split').checkVisibility()"), false);
}

TEST(PageInBrowser, GivesEachPlotsNumbersAsCsv) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.open(pageOf(madeUpVariants()));
  const auto downloaded = [&](const std::string& figure, const std::string& name) {
    return browser.download("document.querySelector('#" + figure + " .under button').click()", name);
  };
  EXPECT_EQ(downloaded("compared_plot", "total-time-of-each-variant.csv"),
            "Lights,Culling,\"Median, ms\",\"Lower quartile, ms\",\"Upper quartile, ms\"\r\n"
            "1,none,2.01,1.91,2.51\r\n100,none,3,2.9,3.5\r\n10000,none,102,101.9,102.5\r\n"
            "1,tiles,2.02,1.92,2.52\r\n100,tiles,4,3.9,4.5\r\n10000,tiles,202,201.9,202.5\r\n"
            "1,\"a \"\"tree\"\", in full\",2.03,1.93,2.53\r\n100,\"a \"\"tree\"\", in full\",5,4.9,5.5\r\n"
            "10000,\"a \"\"tree\"\", in full\",302,301.9,302.5\r\n");
  EXPECT_EQ(downloaded("pairs_plot", "pairs-of-a-pixel-and-a-light-culling-none.csv"),
            "Lights,What,Value\r\n1,evaluated,2000\r\n100,evaluated,200000\r\n10000,evaluated,20000000\r\n"
            "1,in range,1000\r\n100,in range,100000\r\n10000,in range,10000000\r\n");
  EXPECT_THAT(downloaded("growth_table", "growth.csv"),
              StartsWith("Culling,Stage,\"a, ms\",\"b, ms\",c,\"c, low\",\"c, high\",Reason\r\n"
                         "none,total,2,0.01,1,0.95,1.05,\r\nnone,rasterize,,,,,,no growth beyond noise\r\n"));
  EXPECT_THAT(downloaded("points_table", "points.csv"),
              HasSubstr("\r\n1,tiles,2.02,1.92,2.52,2,0.02,2000,1000,2,230400,3,"));
  // The same numbers as a table.
  browser.evaluate("document.querySelector('#compared_plot details').open = true");
  browser.settle();
  EXPECT_EQ(browser.evaluate("document.querySelector('#compared_plot tbody').rows[5].innerText.split('\\t')"),
            Json({"10,000", "tiles", "202 ms", "202 ms", "203 ms"}));
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

TEST(PageInBrowser, SortsItsPointsByAnyColumn) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.open(pageOf(madeUpVariants()));
  const auto click = [&](int column) {
    browser.evaluate("document.querySelectorAll('#points_table thead button')[" + std::to_string(column) +
                     "].click()");
    return browser.evaluate(
        "[...document.querySelectorAll('#points_table tbody tr')].slice(0, 3).map(row => "
        "row.cells[2].innerText)");
  };
  EXPECT_EQ(click(2), Json({"2.01 ms", "2.02 ms", "2.03 ms"}));
  EXPECT_EQ(click(2), Json({"302 ms", "202 ms", "102 ms"}));
  EXPECT_EQ(browser.evaluate("document.querySelectorAll('#points_table th[scope=col]')[2].ariaSort"),
            "descending");
  EXPECT_EQ(click(1)[0], "2.03 ms");
}

TEST(PageInBrowser, FollowsLightAndDark) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.open(pageOf(madeUpVariants()));
  const auto colours = [&] {
    browser.settle();
    return browser.evaluate("[getComputedStyle(document.documentElement).backgroundColor, " +
                            chartOf("stage_plot") + ".data.datasets[0].borderColor, " +
                            chartOf("stage_plot") + ".options.scales.x.ticks.color]");
  };
  EXPECT_EQ(colours(), Json({"rgb(255, 255, 255)", "#1c1e21", "#1c1e21"}));
  browser.setColorScheme("dark");
  EXPECT_EQ(colours(), Json({"rgb(21, 24, 29)", "#e8eaed", "#e8eaed"}));
  browser.setColorScheme("light");
  EXPECT_EQ(colours(), Json({"rgb(255, 255, 255)", "#1c1e21", "#1c1e21"}));
}

/// Text whose contrast with what is behind it is less than 4.5, as WCAG 2.1 defines it, and marks of a plot
/// under 3.
constexpr const char* kFaintTexts = R"((() => {
  const light = channel => (channel /= 255) <= 0.04045 ? channel / 12.92 : ((channel + 0.055) / 1.055) ** 2.4;
  const known = new Map();
  const channels = text => known.get(text) || known.set(text, rasterized(text)).get(text);
  const rasterized = text => { const context = document.createElement('canvas').getContext('2d');
    context.fillStyle = text; context.fillRect(0, 0, 1, 1); return [...context.getImageData(0, 0, 1, 1).data]; };
  const luminance = ([r, g, b]) => 0.2126 * light(r) + 0.7152 * light(g) + 0.0722 * light(b);
  const contrast = (a, b) => { const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y); return (high + 0.05) / (low + 0.05); };
  const behind = element => {
    for (; element; element = element.parentElement) {
      const colour = channels(getComputedStyle(element).backgroundColor);
      if (colour[3] === 255) return colour;
    }
  };
  const faint = [], walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  let texts = 0;
  while (walker.nextNode()) {
    const element = walker.currentNode.parentElement;
    if (!walker.currentNode.data.trim() || !element.checkVisibility() || element.tagName === 'SCRIPT') continue;
    ++texts;
    const found = contrast(channels(getComputedStyle(element).color), behind(element));
    if (found < 4.5) faint.push(`${element.tagName}: ${walker.currentNode.data.trim()}: ${found}`);
  }
  for (const colour of theme().series)
    if (contrast(channels(colour), behind(document.body)) < 3) faint.push(colour);
  if (texts < 50) faint.push(`only ${texts} texts`);
  return faint;
})())";

TEST(PageInBrowser, TextStandsOutInLightAndDark) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  Json data = madeUpHundreds();
  data["incomplete"] = 1;
  browser.open(pageOf(data));
  browser.evaluate("document.querySelectorAll('details').forEach(details => { details.open = true; })");
  for (const char* scheme : {"light", "dark"}) {
    browser.setColorScheme(scheme);
    browser.settle();
    EXPECT_EQ(browser.evaluate(kFaintTexts), Json::array()) << scheme;
  }
}

TEST(PageInBrowser, FitsAPhoneWithoutScrollingSideways) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.resize(320, 640);
  for (Json data : {madeUpVariants(), madeUpHundreds(), madeUpPageOfLightErrors()}) {
    data["settings"]["a_word"] = std::string(200, 'x');
    browser.open(pageOf(data));
    browser.evaluate("document.querySelectorAll('details').forEach(details => { details.open = true; })");
    browser.settle();
    EXPECT_EQ(browser.evaluate("document.documentElement.scrollWidth"), 320);
    EXPECT_EQ(browser.evaluate(
                  R"([...document.querySelectorAll('body *')].filter(element => element.checkVisibility() &&
      !element.closest('.scroll') && element.getBoundingClientRect().right > 320.5).map(element => element.outerHTML.slice(0, 80)))"),
              Json::array());
  }
}

TEST(PageInBrowser, TabReachesEveryControlInItsOrder) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.open(pageOf(madeUpVariants()));
  browser.evaluate(
      R"(window.controls = [...document.querySelectorAll('a[href], button, select, input, summary, [tabindex="0"]')]
    .filter(element => element.checkVisibility()))");
  const int count = browser.evaluate("controls.length");
  EXPECT_GT(count, 40);
  // 0, 1, 2 … and each with an outline.
  for (int i = 0; i < count; ++i) {
    browser.press("Tab", 9);
    ASSERT_EQ(browser.evaluate("controls.indexOf(document.activeElement)"), i)
        << browser.evaluate("document.activeElement.outerHTML.slice(0, 200)");
    EXPECT_EQ(browser.evaluate("getComputedStyle(document.activeElement).outlineStyle"), "solid") << i;
  }
  EXPECT_EQ(browser.evaluate("controls.filter(control => !(control.innerText || control.ariaLabel || "
                             "(control.labels || []).length)).length"),
            0);
}

/// What a PDF (in base64) says, its streams unpacked.
constexpr const char* kUnpacked = R"(async encoded => {
  const bytes = Uint8Array.from(atob(encoded), character => character.charCodeAt(0)), text = atob(encoded);
  let unpacked = text;
  for (const {0: begin, index} of text.matchAll(/FlateDecode[^]{0,80}?stream\r?\n/g)) {
    const from = index + begin.length, to = text.indexOf('endstream', from);
    const stream = new Blob([bytes.subarray(from, to)]).stream().pipeThrough(new DecompressionStream('deflate'));
    const reader = stream.getReader();
    try {
      for (let part; !(part = await reader.read()).done;) unpacked += new TextDecoder('latin1').decode(part.value);
    } catch {}  // at the line break before "endstream", which isn't part of it
  }
  return unpacked;
})";

TEST(PageInBrowser, PrintsItsPlotsInLightColours) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.setColorScheme("dark");
  browser.open(pageOf(madeUpVariants()));
  // A legend has the colours of its plot, which are to be found in the plot itself.
  browser.evaluate(
      "document.querySelectorAll('.legend').forEach(legend => { legend.style.display = 'none'; })");
  browser.evaluate("window.printed = null; addEventListener('beforeprint', () => { printed = {drawn: " +
                   std::string(kPlotsDrawn) + ", colour: " + chartOf("stage_plot") +
                   ".data.datasets[0].borderColor}; })");
  const std::string encoded =
      browser.call("Page.printToPDF", {{"printBackground", true}, {"preferCSSPageSize", true}})["data"];
  EXPECT_EQ(browser.evaluate("printed.colour"), "#1c1e21");
  EXPECT_EQ(browser.evaluate("printed.drawn"), Json({true, true, true, true, true}));
  EXPECT_EQ(browser.evaluate(chartOf("stage_plot") + ".data.datasets[0].borderColor"), "#e8eaed");
  const std::string pdf = browser.evaluate("(" + std::string(kUnpacked) + ")('" + encoded + "')");
  EXPECT_THAT(pdf, StartsWith("%PDF"));
  // Chromium prints a canvas that is drawn for paper as lines: these are the hues of the memory plot's, in no
  // other.
  EXPECT_THAT(pdf, HasSubstr(".8235 .4353 .6078 RG"));
  EXPECT_THAT(pdf, HasSubstr(".3608 .0431 .5961 RG"));
  // Both pictures, in full.
  EXPECT_EQ(countOf(pdf, "/Width 4\n/Height 2"), 2U);
}

TEST(PageInBrowser, FiltersHundredsOfPoints) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  browser.open(pageOf(madeUpHundreds()));
  const auto shown = [&] {
    return Json{linesOf(browser, "compared_plot").size(),
                browser.evaluate("document.querySelectorAll('#points_table tbody tr').length")};
  };
  EXPECT_EQ(shown(), Json({24, 168}));
  // No two lines look alike, and with two axes no two points.
  EXPECT_EQ(
      browser.evaluate(
          "new Set(" + chartOf("compared_plot") +
          ".data.datasets.map(line => [line.borderColor, line.borderDash, line.pointStyle].join())).size"),
      24);
  browser.evaluate(
      "(() => { const select = document.querySelectorAll('#filter select')[1]; select.value = '8'; "
      "select.dispatchEvent(new Event('change')); })()");
  EXPECT_EQ(shown(), Json({6, 42}));
  Json two_axes = madeUpHundreds();
  two_axes["axes"].erase(1);
  Json& points = two_axes["points"];
  points.erase(std::remove_if(points.begin(), points.end(),
                              [](const Json& point) { return point["values"]["tile"] != 8; }),
               points.end());
  browser.open(pageOf(two_axes));
  EXPECT_EQ(browser.evaluate("new Set(" + chartOf("error_plot") +
                             ".data.datasets.filter(line => !line.showLine).map(line => line.borderColor + "
                             "line.pointStyle)).size"),
            6);
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

TEST(PageInBrowser, WorksWithOneVariantOneCountAndNothingElse) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  const Json point{{"lights", 1000}, {"milliseconds", {{"median", 3.2}, {"low", 3.1}, {"high", 3.4}}}};
  const Json nothing{{"title", "t"}, {"points", Json::array()}}, one{{"title", "t"}, {"points", {point}}};
  Json nulls = one;
  for (const char* key :
       {"stages", "pairs_evaluated", "pairs_in_range", "error", "front", "picture", "error_map", "tile_map"})
    nulls["points"][0][key] = nullptr;
  Json variants = madeUpVariants();
  variants["points"] = {variants["points"][0], variants["points"][3]};
  for (const auto& [data, sections] : std::vector<std::pair<Json, Json>>{
           {nothing, Json::array()},
           {one, {"stages", "points"}},
           {nulls, {"stages", "points"}},
           {variants, {"compared", "stages", "growth", "error", "pictures", "points"}}}) {
    browser.open(pageOf(data));
    EXPECT_EQ(browser.evaluate("[...document.querySelectorAll('main > section')].filter(section => "
                               "section.checkVisibility()).map(section => section.id)"),
              sections);
    for (const Json& drawn : browser.evaluate(kPlotsDrawn)) EXPECT_EQ(drawn, true);
  }
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

}  // namespace
}  // namespace luciole::test
