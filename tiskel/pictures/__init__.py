"""Pictures of results, drawn without a screen; matplotlib is imported only here, and only to draw."""
