// The sampler between texels, to the edge. Its name says what it does (pipelines/README.md).

var linear_clamp: sampler;
