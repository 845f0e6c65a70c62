#pragma once
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace lumi::test {

/// Is there a Python with jsonschema?
inline bool haveSchemaValidator() { return std::system("python3 -c 'import jsonschema' 2>/dev/null") == 0; }

/// What python3-jsonschema says of each document: '1' valid, '0' not. One run of Python for all.
inline std::string schemaVerdicts(const std::filesystem::path& schema,
                                  const std::vector<std::filesystem::path>& documents) {
    std::string command =
        "python3 -c '"
        "import json,sys,jsonschema\n"
        "s=json.load(open(sys.argv[1]));c=jsonschema.validators.validator_for(s);c.check_schema(s)\n"
        "print(*(int(c(s).is_valid(json.load(open(f)))) for f in sys.argv[2:]),sep=\"\")' " +
        schema.string();
    for (const std::filesystem::path& document : documents) command += ' ' + document.string();
    std::string answer;
    if (FILE* pipe = popen(command.c_str(), "r")) {
        for (int c = fgetc(pipe); c != EOF && c != '\n'; c = fgetc(pipe)) answer += static_cast<char>(c);
        pclose(pipe);
    }
    return answer;
}

}  // namespace lumi::test
