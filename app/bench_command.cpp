#include "app/bench_command.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "base/error.h"
#include "study/bench.h"

namespace lumi {
using nlohmann::json;
namespace {

json toJson(const BenchResult& result) {
    const auto orNull = [](double value) { return value > 0 && std::isfinite(value) ? json(value) : json(); };
    json all = {{"name", result.name},
                {"value", result.value},
                {"unit", result.unit},
                {"median_ms", orNull(result.medianMs)},
                {"spread", result.spread},
                {"limit", orNull(result.limit)},
                {"ratio_to_limit", orNull(result.ratioToLimit())}};
    if (result.isMark) all["holds"] = result.holds();
    return all;
}

void printRow(const BenchResult& result) {
    std::string row = fmt::format("{:<38}{:>10.3f} {:<8}", result.name, result.value, result.unit);
    row += result.medianMs > 0 ? fmt::format("{:>10.1f}{:>7.0f}%", result.medianMs, 100 * result.spread)
                               : fmt::format("{:>10}{:>8}", "", "");
    if (result.limit > 0) row += fmt::format("{:>10.3f}{:>8.2f}", result.limit, result.ratioToLimit());
    if (result.isMark) row += result.holds() ? "  holds" : "  missed";
    std::puts(row.c_str());
    std::fflush(stdout);
}

}  // namespace

int runBenchCommand(const std::string& filter, bool check, const MachineOptions& machine, MessageLog& log,
                    std::stop_token stop) {
    json results = json::array();
    bool first = true, holds = true;
    const auto onResult = [&](const BenchResult& result) {
        results.push_back(toJson(result));
        holds = holds && result.holds();
        if (machine.json) return;
        if (std::exchange(first, false))
            std::puts(fmt::format("{:<38}{:>10} {:<8}{:>10}{:>8}{:>10}{:>8}", "name", "value", "unit", "median ms",
                                  "spread", "limit", "ratio")
                          .c_str());
        printRow(result);
    };
    printMessages(log, machine);
    runBench({.filter = filter, .program = "/proc/self/exe", .stop = stop}, log, onResult);
    if (machine.json) std::puts(json{{"results", results}}.dump(2).c_str());
    return check && !holds ? static_cast<int>(ErrorKind::CheckFailed) : 0;
}

}  // namespace lumi
