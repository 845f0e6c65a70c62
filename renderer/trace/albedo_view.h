#pragma once

namespace lumi {

/// The albedos of facets as the kernels read them; see SchlickAlbedo.
struct AlbedoView {
    const float* smooth = nullptr;   ///< pairs, `columns` to a row
    const float* average = nullptr;  ///< pairs, a row each
    int rows = 0, columns = 0, averageRows = 0, averageSteps = 0;
    float leastRoughness = 0;
};

}  // namespace lumi
