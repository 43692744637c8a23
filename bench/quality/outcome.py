"""What a verb answered for one piece of material, beside the truth."""


def outcome(answer, wrong, truth, said, interval):
    """`answer`: the verb's JSON or {"refused": ...}; `truth`, `said`, `interval`: texts for the table."""
    if "refused" in answer:
        return {"quality": "refused", "wrong": False, "truth": truth, "said": answer["refused"], "interval": "", "aspects": []}
    return {"quality": answer["quality"], "wrong": bool(wrong), "truth": truth, "said": said, "interval": interval,
            "aspects": sorted({w["aspect"] for w in answer["warnings"]})}


def inside(low, value, high):
    return low is not None and high is not None and low <= value <= high
