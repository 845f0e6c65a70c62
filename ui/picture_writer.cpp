#include "ui/picture_writer.h"

#include "base/files.h"
#include "image/png.h"

namespace lumi {

void PictureWriter::write(Image8 picture, const std::filesystem::path& path) {
    std::erase_if(pending_, [](const std::future<void>& f) {
        return f.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    pending_.push_back(std::async(std::launch::async, [this, path, image = std::move(picture)] {
        try {
            log_.info("Saved " + writeNewFile(path, encodePng(image)).string());
        } catch (const std::exception& error) {
            log_.error(error.what());
        }
    }));
}

}  // namespace lumi
