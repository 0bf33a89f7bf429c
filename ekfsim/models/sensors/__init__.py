"""h, H, R and residual, a file a sensor."""
