"""The trade of speed for accuracy: what every knob of a scene costs and spoils, and the cheapest settings for a target."""
