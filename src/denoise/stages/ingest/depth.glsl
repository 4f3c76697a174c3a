// The encodings of an embedding program's depth. The including shader declares `IngestParams params` beforehand.

/// The distance along the ray; 0 where nothing is seen. `v` is the ray; its component along the view axis is 1.
float givenDistance(float z, vec3 v) {
    if (params.depthKind == DEPTH_DEVICE) {
        if (params.reversed != 0u ? !(z > 0.0) : !(z < 1.0)) return 0.0;
        const vec4 p = params.deviceDepth;
        z = abs((z * p.w - p.y) / (p.x - z * p.z));
    } else {
        if (params.depthKind == DEPTH_LINEAR) z = abs(z);
        if (!(z > 0.0 && z < params.farDepth)) return 0.0;
    }
    const bool alongRay = params.depthKind == DEPTH_DISTANCE || params.camera.orthographic != 0u;
    const float distance = alongRay ? z : z * length(v);
    return isinf(distance) ? 0.0 : distance;
}
