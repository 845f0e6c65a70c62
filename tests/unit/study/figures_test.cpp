#include "study/figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/messages.h"
#include "image/exr.h"
#include "image/png.h"
#include "study/canvas.h"
#include "study/figure_values.h"
#include "study/number_text.h"
#include "study/study_file.h"
#include "support/temporary_folder.h"

namespace lumi::test {
namespace {

constexpr Extent2 kExtent{64, 36};

Image flat(float value) {
    Image image(kExtent, 3);
    image.fill(value);
    return image;
}

void write(const std::filesystem::path& path, const Image& image) {
    ExrLayers layers;
    layers.add("", "RGB", image);
    writeExr(path, layers);
}

/// A study of two methods and three seeds on a grey reference: "near" is off by little everywhere, "far" by much in the
/// left half only.
struct Made {
    TemporaryFolder folder;
    Study study = parseStudy(R"({"version": 1, "scenes": ["cornell"], "seeds": [1, 2, 3], "metrics": ["mse"],
        "entries": [{"name": "noisy", "module": "none"}, {"name": "near", "module": "accumulate"}, {"name": "far", "module": "accumulate"}],
        "figures": [{"name": "strip", "metric": "mse", "crops": [{"name": "left", "box": [0.125, 0.25, 0.25, 0.5]}, {"box": [0.625, 0.25, 0.25, 0.5]}]}]})",
                             "t.json", "");
    StudyPlan plan = planStudy(study);
    StudyRecords records;
    Made() {
        write(folder / "reference.exr", flat(0.5f));
        records.references.push_back({0, 0, "reference.exr", 0, {{"mse", 0}}, {}, 0, {}});
        for (size_t seed = 0; seed < 3; ++seed)
            for (size_t method = 0; method < 3; ++method) {
                const float wobble = 0.001f * static_cast<float>(seed);
                Image image = flat(method == 0 ? 0.9f - wobble : 0.51f + wobble);
                for (int y = 0; y < kExtent.height && method == 2; ++y)
                    for (int x = 0; x < kExtent.width / 2; ++x) image.at(0, x, y) = 0.7f + wobble;
                StudyRow row;
                row.method = method, row.frame = 0, row.seed = study.seeds[seed];
                row.image = folder / ("m" + std::to_string(method) + std::to_string(seed) + ".exr");
                row.reference = folder / "reference.exr";
                row.metrics["mse"] = 0;
                write(row.image, image);
                records.rows.push_back(row);
            }
    }
};

TEST(Figures, ValuesAreThoseOfTheCrops) {
    const Made made;
    const FigureContent content = figureContent(made.study, made.plan, made.records, made.study.figures[0]);
    ASSERT_EQ(content.columns.size(), 3u);
    EXPECT_EQ(content.columns[0].title, "noisy") << "the input stands first";
    EXPECT_EQ(content.boxes[0].x, 8);
    EXPECT_EQ(content.boxes[0].height, 18);
    const FigureColumn& far = content.columns[2];
    EXPECT_NEAR(far.crops[0][0], (0.04 + 2 * 0.0001) / 3, 1e-6) << "red is off in the left crop";
    EXPECT_NEAR(far.crops[1][0], 0.0001, 1e-7) << "and not in the right";
    EXPECT_NEAR(far.whole[0], (far.crops[0][0] + far.crops[1][0]) / 2, 1e-7);
    EXPECT_NEAR(content.columns[1].crops[0][2], 0.012 * 0.012, 1e-7) << "each seed has its own";
}

/// Over the whole picture the numbers are those of the tables: without what the reference's noise adds.
TEST(Figures, WholePicturesLoseTheReferencesOwnError) {
    Made made;
    const auto farValues = [&](const char* metric) {
        made.study.figures[0].metric = metric;
        return figureContent(made.study, made.plan, made.records, made.study.figures[0]).columns[2];
    };
    const FigureColumn plain = farValues("mse");
    made.records.references[0].floor["mse"] = 0.004;
    const FigureColumn corrected = farValues("mse");
    EXPECT_NEAR(corrected.whole[1], plain.whole[1] - 0.004, 1e-9);
    EXPECT_EQ(corrected.crops[0][1], plain.crops[0][1]) << "how much of it is in a crop is not known";
    const double rmse = farValues("rmse").whole[1];
    made.records.references[0].floor["rmse"] = rmse / 2;
    EXPECT_NEAR(farValues("rmse").whole[1], std::sqrt(0.75) * rmse, 1e-9);
    MessageLog log;
    made.study.figures[0].metric = "mse";
    EXPECT_NE(
        drawFigures(made.study, made.plan, made.records, log).at(0).caption.find("without the reference's own error"),
        std::string::npos);
    made.study.figures[0].metric = "relmse";
    EXPECT_NE(
        drawFigures(made.study, made.plan, made.records, log).at(0).caption.find("all with the reference's own error"),
        std::string::npos);
    made.study.figures[0].metric = "flip";
    EXPECT_EQ(drawFigures(made.study, made.plan, made.records, log).at(0).caption.find("own error"), std::string::npos);
}

TEST(Figures, AStripIsDrawnAsSvgAndPng) {
    const Made made;
    MessageLog log;
    const std::vector<DrawnFigure> figures = drawFigures(made.study, made.plan, made.records, log);
    ASSERT_EQ(figures.size(), 1u);
    const std::string& svg = figures[0].svg;
    // The picture, six insets with their maps, two of the reference, and the bar of the map's colours.
    const auto count = [&](const std::string& part) {
        size_t found = 0;
        for (size_t at = svg.find(part); at != std::string::npos; at = svg.find(part, at + 1)) ++found;
        return found;
    };
    EXPECT_EQ(count("<image "), 1u + 2 * 2 * 3 + 2 + 1);
    EXPECT_EQ(count("data:image/png;base64,"), count("<image "));
    EXPECT_EQ(count("fill=\"none\" stroke="), 2u + 2 * 4) << "crops are marked in the picture, and their insets framed";
    for (const char* text : {">noisy<", ">near<", ">far<", ">Reference<", ">cornell<", ">left<"})
        EXPECT_EQ(count(text), 1u) << text;
    EXPECT_NE(svg.find("±"), std::string::npos);
    EXPECT_NE(svg.find("aria-label=\"cornell, frame 0, 1 spp"), std::string::npos);

    const Image8 png = decodePng(figures[0].png, "strip").image8();
    EXPECT_EQ(png.extent.width, std::lround(2 * figures[0].width));
    const auto pixel = [&](double x, double y) {
        const uint8_t* p =
            png.rgba.data() + 4 * (size_t(std::lround(2 * y)) * size_t(png.extent.width) + size_t(std::lround(2 * x)));
        return std::array<int, 3>{p[0], p[1], p[2]};
    };
    // sRGB of 0.5 is 188; the paper is white, the first crop's frame is its colour.
    EXPECT_EQ(pixel(1, 1), (std::array{255, 255, 255}));
    EXPECT_EQ(pixel(12, 50), (std::array{188, 188, 188}));
    int framed = 0, ink = 0;
    for (size_t i = 0; i < png.rgba.size(); i += 4) {
        framed += png.rgba[i] == 230 && png.rgba[i + 1] == 159 && png.rgba[i + 2] == 0;
        ink += png.rgba[i] < 60 && png.rgba[i + 1] < 60 && png.rgba[i + 2] < 60;
    }
    EXPECT_GT(framed, 2000) << "frames of the first crop";
    EXPECT_GT(ink, Lettering::find(Lettering::Weight::Regular) ? 500 : -1) << "text";
}

/// Bold is what the intervals tell from all others, and nothing else.
TEST(Figures, TheBestIsBoldOnlyWhereTheNoiseAllows) {
    Made made;
    MessageLog log;
    const auto bolds = [&] {
        const std::string svg = drawFigures(made.study, made.plan, made.records, log).at(0).svg;
        size_t found = 0;
        for (size_t at = svg.find("font-weight"); at != std::string::npos; at = svg.find("font-weight", at + 1))
            ++found;
        return found;
    };
    // Heads: the scene, one crop's name, three columns and the reference. Values: near is best in the left crop and
    // over the whole picture; in the right one near and far are the same.
    EXPECT_EQ(bolds(), 6u + 2);
    made.study.seeds = {1};
    std::erase_if(made.records.rows, [](const StudyRow& row) { return row.seed != 1; });
    EXPECT_EQ(bolds(), 6u) << "one seed tells nothing";
}

TEST(Figures, AreaAveragesKeepSquaresAndMeans) {
    const Image8 two{{2, 1}, {0, 0, 0, 255, 200, 100, 50, 255}};
    const Image8 big = resampled(two, {5, 2});
    EXPECT_EQ(big.rgba[4 * 1], 0);
    EXPECT_EQ(big.rgba[4 * 2], 100) << "the pixel in the middle lies over both";
    EXPECT_EQ(big.rgba[4 * 3], 200);
    EXPECT_EQ(resampled(big, {1, 1}).rgba[0], 100);
    EXPECT_EQ(resampled(two, {2, 1}).rgba, two.rgba);
}

Interval interval(double mean, double half) { return {3, mean, half / 4, mean - half, mean + half}; }

TEST(Numbers, ShowTheDigitsThatMeanSomething) {
    EXPECT_EQ(plainText(numberText(interval(0.123456, 0.0123))), "0.123 ± 0.012");
    EXPECT_EQ(plainText(numberText(interval(0.123456, 0.00000012))), "0.123456 ± 0.000000") << "at most six digits";
    EXPECT_EQ(plainText(numberText(interval(123.456, 45))), "123 ± 45");
    EXPECT_EQ(plainText(numberText(interval(1.23456e-5, 2e-7))), "(1.235 ± 0.020)·10⁻⁵");
    EXPECT_EQ(plainText(numberText(interval(4.01, 12.6))), "4 ± 13");
    EXPECT_EQ(plainText(numberText(interval(0.5, 1e-17))), "0.5000 ± 0.0000");
    EXPECT_EQ(plainText(numberText(interval(0, 0.02))), "0.000 ± 0.020");
    EXPECT_EQ(plainText(numberText(interval(0, 0))), "0.000 ± 0.000");
    EXPECT_EQ(plainText(numberText(interval(-3.14159, 0.5))), "-3.14 ± 0.50");
    EXPECT_EQ(plainText(numberText({1, 0.123456, NAN, NAN, NAN})), "0.1235");
    EXPECT_EQ(plainText(numberText({0, NAN, NAN, NAN, NAN})), "-");
    EXPECT_EQ(latexText(numberText(interval(0.123456, 0.0123)), true), "$\\mathbf{0.123} \\pm 0.012$");
    EXPECT_EQ(latexText(numberText(interval(1.23456e-5, 2e-7)), false), "$(1.235 \\pm 0.020) \\cdot 10^{-5}$");
}

TEST(Lettering, DecodesUtf8AndDrawsInk) {
    EXPECT_EQ(decodeUtf8("a±⁻"), (std::vector<uint32_t>{'a', 0xb1, 0x207b}));
    EXPECT_EQ(decodeUtf8("\xff\xc2"), (std::vector<uint32_t>{0xfffd, 0xfffd})) << "broken bytes are one mark each";
    const Lettering* font = Lettering::find(Lettering::Weight::Regular);
    if (!font) GTEST_SKIP() << "neither Inter nor DejaVu Sans is installed";
    EXPECT_GT(font->width("wide", 20), 1.5 * font->width("ii", 20));
    EXPECT_NEAR(font->width("text", 40), 2 * font->width("text", 20), 0.01);
    Image8 image{{40, 20}, std::vector<uint8_t>(40 * 20 * 4, 255)};
    font->draw(image, -5, 15, 16, "Wide text that leaves the image", {0, 0, 0});
    EXPECT_LT(*std::min_element(image.rgba.begin(), image.rgba.end()), 20);
}

}  // namespace
}  // namespace lumi::test
