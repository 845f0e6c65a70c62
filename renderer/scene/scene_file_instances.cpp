#include <fmt/format.h>

#include <utility>

#include "base/error.h"
#include "scene/scene_file_parts.h"

namespace lumi {
namespace {

/// One entry of "instances", its names not yet resolved.
struct InstanceEntry {
    const JsonValue* value = nullptr;
    std::string name;
    const JsonValue* parentValue = nullptr;
    int parent = -1;  ///< index into the entries
};

std::vector<InstanceEntry> readNames(SceneFileContext& context, const JsonValue& section) {
    if (!section.isArray()) refuseValue(context.tree, section, "instances", "an array");
    std::vector<InstanceEntry> entries;
    std::map<std::string, size_t> byName;
    std::map<std::string, int> numbers;
    for (const JsonValue& item : section.items) {
        ObjectReader reader(context.tree, item, "instances");
        const std::string asset = reader.text("asset").value_or("group");
        InstanceEntry entry{&item, reader.text("name").value_or(""), reader.find("parent"), -1};
        // Nameless ones are numbered: "ball", "ball-2", "ball-3".
        while (entry.name.empty()) {
            const int number = ++numbers[asset];
            const std::string name = number == 1 ? asset : fmt::format("{}-{}", asset, number);
            if (!byName.contains(name)) entry.name = name;
        }
        if (!byName.emplace(entry.name, entries.size()).second)
            reader.fail(reader.find("name")->at, fmt::format("two instances are named \"{}\"", entry.name));
        entries.push_back(std::move(entry));
    }
    for (InstanceEntry& entry : entries) {
        if (!entry.parentValue) continue;
        const std::string parent = readText(context.tree, *entry.parentValue, "parent");
        const auto found = byName.find(parent);
        if (found == byName.end()) refuseName(context.tree, entry.parentValue->at, "instance", parent, namesOf(byName));
        entry.parent = static_cast<int>(found->second);
    }
    return entries;
}

/// Indices of the entries, parents before their children and otherwise in document order. Refuses cycles.
std::vector<size_t> parentsFirst(const SceneFileContext& context, const std::vector<InstanceEntry>& entries) {
    enum class State { New, Open, Done };
    std::vector<State> states(entries.size(), State::New);
    std::vector<size_t> order, chain;
    for (size_t start = 0; start < entries.size(); ++start) {
        for (int i = static_cast<int>(start); i >= 0 && states[static_cast<size_t>(i)] != State::Done;
             i = entries[static_cast<size_t>(i)].parent) {
            const auto index = static_cast<size_t>(i);
            if (states[index] == State::Open)
                throwBadInput({fmt::format("instance \"{}\" is its own ancestor", entries[index].name),
                               context.tree.where(entries[index].parentValue->at), "", ""});
            states[index] = State::Open;
            chain.push_back(index);
        }
        for (; !chain.empty(); chain.pop_back()) {
            order.push_back(chain.back());
            states[chain.back()] = State::Done;
        }
    }
    return order;
}

int materialNamed(const SceneFileContext& context, const JsonValue& value, const std::string& key) {
    const std::string name = readText(context.tree, value, key);
    const auto found = context.materials.find(name);
    if (found == context.materials.end())
        refuseName(context.tree, value.at, "material", name, namesOf(context.materials));
    return found->second;
}

/// "material" fills every slot, "materials" fills slots by their names.
SlotFilling readSlots(SceneFileContext& context, ObjectReader& reader, const PlacedAsset& asset) {
    const std::vector<Material>& slots = asset.content.materials;
    SlotFilling filling(slots.size(), -1);
    if (const JsonValue* all = reader.find("material"))
        filling.assign(slots.size(), materialNamed(context, *all, "material"));
    const JsonValue* some = reader.find("materials");
    for (const JsonMember& member : membersOf(context, some, "materials")) {
        bool found = false;
        std::vector<std::string> names;
        for (size_t i = 0; i < slots.size(); ++i) {
            names.push_back(slots[i].name);
            if (slots[i].name != member.key) continue;
            filling[i] = materialNamed(context, member.value, member.key);
            found = true;
        }
        if (!found)
            refuseName(context.tree, member.at, fmt::format("material slot of asset \"{}\"", asset.name), member.key,
                       names);
    }
    return filling;
}

void readInstance(SceneFileContext& context, const InstanceEntry& entry, int node) {
    ObjectReader reader(context.tree, *entry.value, entry.name);
    reader.find("name");
    reader.find("parent");
    readPlacement(context, reader, node, {.scale = true, .look = false});
    // An instance without an asset is a group: a place that others name as their parent.
    const JsonValue* assetName = reader.find("asset");
    if (!assetName) {
        reader.finish();
        return;
    }
    const std::string name = readText(context.tree, *assetName, "asset");
    const auto asset = context.assets.find(name);
    if (asset == context.assets.end()) refuseName(context.tree, assetName->at, "asset", name, namesOf(context.assets));
    const SlotFilling filling = readSlots(context, reader, asset->second);
    reader.finish();
    placeAsset(context.scene, asset->second, entry.name, node, filling);
}

}  // namespace

void readInstances(SceneFileContext& context, const JsonValue* section) {
    if (!section) return;
    const std::vector<InstanceEntry> entries = readNames(context, *section);
    // All places first, so that a child may stand before its parent in the file.
    for (const size_t index : parentsFirst(context, entries)) {
        const InstanceEntry& entry = entries[index];
        Node node;
        node.name = entry.name;
        if (entry.parent >= 0) node.parent = context.instanceNodes.at(entries[static_cast<size_t>(entry.parent)].name);
        context.instanceNodes[entry.name] = static_cast<int>(context.scene.nodes.size());
        context.scene.nodes.push_back(std::move(node));
    }
    for (const InstanceEntry& entry : entries) readInstance(context, entry, context.instanceNodes.at(entry.name));
}

}  // namespace lumi
