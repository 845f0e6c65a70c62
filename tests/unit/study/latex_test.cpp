#include "study/latex.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "study/study_file.h"

namespace lumi::test {
namespace {

/// Three methods with four seeds: "best" is surely so by mse; by rmse nothing is told from anything.
struct Sample {
    Study study =
        parseStudy(R"({"version": 1, "title": "50% & more_#1", "scenes": ["cornell", {"scene": "room", "name": "a_b"}],
        "seeds": [1, 2, 3, 4], "metrics": ["mse", "rmse"], "spp": [1, 2],
        "entries": [{"name": "best_of", "module": "accumulate"}, {"name": "b", "module": "accumulate"}, {"name": "c", "module": "none"}],
        "pairs": [{"entry": "best_of", "against": "b"}],
        "ablations": [{"entry": "best_of", "stages": [{"name": "the limit", "set": {"limit": true}}]}]})",
                   "t_x.json", "");
    StudyPlan plan = planStudy(study);
    StudyRecords records;

    Sample() {
        for (size_t scene = 0; scene < 2; ++scene)
            for (const int spp : study.spp)
                for (const int seed : study.seeds)
                    for (size_t method = 0; method < plan.methods.size(); ++method) add(scene, spp, seed, method);
    }
    void add(size_t scene, int spp, int seed, size_t method) {
        StudyRow row;
        row.scene = scene, row.method = method, row.spp = spp, row.seed = seed;
        const double level[] = {1, 2, 4, 1.5};
        row.metrics = {{"mse", (level[method] + 0.01 * seed) / spp},
                       {"rmse", 1 + 0.1 * ((seed * 7 + static_cast<int>(method) * 3) % 5)}};
        records.rows.push_back(row);
        records.times.push_back({scene,
                                 method,
                                 spp,
                                 seed,
                                 10.0 * spp,
                                 0.5,
                                 1.0 + static_cast<double>(method) + 0.01 * seed,
                                 1000,
                                 {{"stage", 0.5}}});
    }
    std::vector<LatexTable> tables() const {
        return latexTables(study, plan, summarize(study, plan, records), summarizeTimes(study, plan, records));
    }
    std::string table(const std::string& name) const {
        for (const LatexTable& table : tables())
            if (table.name == name) return table.text;
        return "";
    }
};

/// What would stop LaTeX: braces and dollars that do not pair, environments that do not close, characters that mean
/// something, rows with a wrong number of cells.
void expectSound(const std::string& text, const std::string& name) {
    int braces = 0, dollars = 0;
    std::vector<std::string> environments;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '%' && (i == 0 || text[i - 1] == '\n')) {
            i = text.find('\n', i);
            continue;
        }
        if (c == '\\') {
            for (const std::string word : {"begin{", "end{"})
                if (text.compare(i + 1, word.size(), word) == 0) {
                    const size_t from = i + 1 + word.size(), to = text.find('}', from);
                    const std::string environment = text.substr(from, to - from);
                    if (word == "begin{") environments.push_back(environment);
                    else {
                        ASSERT_FALSE(environments.empty()) << name;
                        EXPECT_EQ(environments.back(), environment) << name;
                        environments.pop_back();
                    }
                }
            ++i;  // an escaped character is text
            continue;
        }
        braces += c == '{' ? 1 : c == '}' ? -1 : 0;
        dollars += c == '$';
        ASSERT_GE(braces, 0) << name;
        EXPECT_TRUE(c != '#' && c != '%' && c != '~') << name << ": " << text.substr(i > 20 ? i - 20 : 0, 40);
        EXPECT_TRUE(dollars % 2 == 1 || (c != '_' && c != '^')) << name << ": " << text.substr(i > 20 ? i - 20 : 0, 40);
    }
    EXPECT_EQ(braces, 0) << name;
    EXPECT_EQ(dollars % 2, 0) << name;
    EXPECT_TRUE(environments.empty()) << name;
}

/// Cells of a row: separators that are not escaped, and those that span several.
size_t cellsOf(const std::string& line) {
    size_t cells = 1;
    for (size_t i = 0; i < line.size(); ++i)
        if (line[i] == '&' && (i == 0 || line[i - 1] != '\\')) ++cells;
    for (size_t at = line.find("\\multicolumn{"); at != std::string::npos; at = line.find("\\multicolumn{", at + 1))
        cells += static_cast<size_t>(line[at + 13] - '0') - 1;
    return cells;
}

TEST(Latex, EveryTableIsSound) {
    const Sample sample;
    const std::vector<LatexTable> tables = sample.tables();
    std::vector<std::string> names;
    for (const LatexTable& table : tables) {
        names.push_back(table.name);
        expectSound(table.text, table.name);
        const size_t begin = table.text.find("\\begin{tabular}{") + 16, end = table.text.find("}\n", begin);
        const std::string columns = table.text.substr(begin, end - begin);
        const size_t expected = columns[0] == 'l' && columns.find("p{") != std::string::npos ? 2 : columns.size();
        size_t rows = 0, at = end;
        for (size_t stop = table.text.find("\\\\", at); stop != std::string::npos;
             at = stop + 2, stop = table.text.find("\\\\", at), ++rows)
            EXPECT_EQ(cellsOf(table.text.substr(at, stop - at)), expected)
                << table.name << ": " << table.text.substr(at, stop - at);
        EXPECT_GT(rows, 1u) << table.name;
    }
    EXPECT_EQ(names, (std::vector<std::string>{"results-cornell", "results-a-b", "results-all-scenes", "times-cornell",
                                               "times-a-b", "equal-cornell", "equal-a-b", "ablation-cornell",
                                               "ablation-a-b", "ablation-all-scenes", "metrics"}));
    const std::string document = latexDocument(sample.study, {}, tables);
    expectSound(document, "all.tex");
    for (const std::string& name : names) EXPECT_NE(document.find("\\input{" + name + "}"), std::string::npos);
}

TEST(Latex, BoldIsOnlyWhatTheIntervalsTell) {
    const Sample sample;
    const std::string text = sample.table("results-cornell");
    // Two sample counts: best_of by mse; nobody by rmse.
    size_t bold = 0;
    for (size_t at = text.find("\\mathbf"); at != std::string::npos; at = text.find("\\mathbf", at + 1)) ++bold;
    EXPECT_EQ(bold, 2u);
    EXPECT_NE(text.find("best\\_of & 1 & $\\mathbf{1.025} \\pm 0.021$"), std::string::npos) << text;
    EXPECT_NE(text.find("50\\% \\& more\\_\\#1"), std::string::npos);
    EXPECT_EQ(text.find("without"), std::string::npos) << "stages have a table of their own";
    const std::string metrics = sample.table("metrics");
    EXPECT_NE(metrics.find("$\\downarrow$"), std::string::npos);
}

TEST(Latex, AblationsTellWhatAStageIsWorth) {
    const std::string text = Sample().table("ablation-cornell");
    // Without the stage: mse 0.5 more in every seed, 3 ms more; both are told from none.
    EXPECT_NE(text.find("best\\_of & the limit & 1 & $\\mathbf{+0.5000} \\pm 0.0000$"), std::string::npos) << text;
    EXPECT_NE(text.find("$\\mathbf{+3.000} \\pm 0.000$"), std::string::npos) << text;
}

/// A stage that is switched off by a value of the document is another job, with samples of its own.
TEST(Latex, AblationsSayWhichSamplesDiffer) {
    EXPECT_NE(Sample().table("ablation-cornell").find("on the same samples. "), std::string::npos);
    Sample sample;
    sample.study.ablations[0].stages[0].set = {{"path.max-depth", "1", ""}};
    EXPECT_NE(sample.table("ablation-cornell").find("on the same samples; not so best\\_of without the limit, traced"),
              std::string::npos);
}

TEST(Latex, EscapesWhatMeansSomething) {
    EXPECT_EQ(escapedLatex("a&b%c$d#e_f{g}h~i^j\\k<l>\nm"),
              "a\\&b\\%c\\$d\\#e\\_f\\{g\\}h\\textasciitilde{}i\\textasciicircum{}j\\textbackslash{}k\\textless{}"
              "l\\textgreater{} m");
}

/// Seed by seed: b has half the error at twice the time, so best_of's error is b's at 2 spp and twice the time.
TEST(Times, EqualTimeAndEqualErrorHaveIntervals) {
    const Sample sample;
    const StudyTimes times = summarizeTimes(sample.study, sample.plan, sample.records);
    EXPECT_EQ(times.methods.size(), 2u * 2 * 4);
    const StudyMeanTime* time = times.find(0, 0, 1);
    ASSERT_NE(time, nullptr);
    EXPECT_NEAR(time->frameMs.mean, 11.525, 1e-9);
    EXPECT_TRUE(time->frameMs.known() && time->stagesMs.at("stage").known());
    const auto found = std::find_if(times.pairs.begin(), times.pairs.end(), [](const StudyEqual& equal) {
        return equal.scene == 0 && equal.spp == 1 && equal.metric == "mse";
    });
    ASSERT_NE(found, times.pairs.end());
    // best_of reaches 1.01 to 1.04 in 11.5 ms; b has 1.005 to 1.02 in 22.5 ms, and 2.01 to 2.04 in 12.5 ms.
    EXPECT_EQ(found->otherAtEqualTime.count, 0) << "b is never that fast";
    EXPECT_EQ(found->otherMsAtEqualValue.count, 4);
    EXPECT_NEAR(found->otherMsAtEqualValue.mean, 22.2, 0.3);
    EXPECT_NEAR(found->timesAsLong.mean, 1.93, 0.03);
    EXPECT_TRUE(found->timesAsLong.known());
    for (const StudyStageTime& stage : times.stages) EXPECT_NEAR(stage.differenceMs.mean, 3, 1e-9);
    EXPECT_EQ(times.stages.size(), 4u);
}

/// A wiggle in the other's curve, above or below the value, puts it not out of range.
TEST(Times, EqualErrorIsFoundOnACurveThatTurnsBack) {
    Sample sample;
    sample.study.spp = {1, 2, 4};
    for (const int seed : sample.study.seeds)
        for (size_t method = 0; method < 2; ++method) sample.add(0, 4, seed, method);
    for (StudyRow& row : sample.records.rows)
        if (row.scene == 0 && row.method == 1 && row.spp == 4)
            row.metrics["mse"] = 1.1;  // 2.01 at 1 spp and 1.005 at 2
    const StudyTimes times = summarizeTimes(sample.study, sample.plan, sample.records);
    const auto found = std::find_if(times.pairs.begin(), times.pairs.end(), [](const StudyEqual& equal) {
        return equal.scene == 0 && equal.spp == 1 && equal.metric == "mse";
    });
    ASSERT_NE(found, times.pairs.end());
    EXPECT_EQ(found->otherMsAtEqualValue.count, 4);
}

}  // namespace
}  // namespace lumi::test
