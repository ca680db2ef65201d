"""Pictures of a Gemmule run: time series, snapshots of the membrane, the mesh."""
